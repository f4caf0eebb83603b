//! `switchback gap --power`

use super::Model;
use super::diagnose::request;
use crate::answer::{Answer, Stored};
use crate::call::{Call, Heard, Stoppable};
use crate::options::Options;
use crate::records::Records;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use std::sync::Arc;
use switchback_io::diagnosis::GivenModel;
use switchback_io::values::whole;
use switchback_lab::generate::EFFECTS;
use switchback_lab::power::{Context, Request, json, measure, words};
use switchback_report::power::artefacts;

/// Which effects these records would have shown.
#[pyfunction]
#[pyo3(signature = (records, options, model=None, heard=None))]
pub(crate) fn power(
    py: Python<'_>,
    records: &Records,
    mut options: Options,
    model: Option<Model>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    Call::run(py, &heard, move |call| {
        let settings = request(&mut options)?.settings();
        let plan = faults(&mut options)?.plan(&settings)?;
        let threads = options.threads()?;
        options.finish()?;
        let model = model.map(|(path, text)| GivenModel::of_text(&path, &text)).transpose()?;
        let place = about.place.display().to_string();
        // What is found is reported with the ground that it was found on, which borrows the rig.
        let measured = threads.install(|| {
            let context = Context::new(&rig, model, settings, &place)?;
            let power = measure(&context, &plan, &Stoppable(call), || {})?;
            let (json, words) = (json(&power, &context), words(&power, &context));
            Ok::<_, Refusal>(Stored::new(json, words, artefacts(&power, &context)).reading(about.inputs))
        });
        Ok(Answer::new(measured??))
    })
}

/// What is asked of the measurement.
fn faults(options: &mut Options) -> Result<Request, Refusal> {
    let plain = Request::default();
    Ok(Request {
        effects: options.names("--effects <EFFECT,…>", &EFFECTS, |effect| *effect)?,
        draws: options.value("--draws <N>", whole(Request::DRAWS))?.unwrap_or(plain.draws),
        seed: options.value("--seed <SEED>", whole(0..=u64::MAX))?.unwrap_or(plain.seed),
    })
}
