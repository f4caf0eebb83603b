//! `switchback gap --power`

use super::{Model, Options, options};
use crate::answer::{Answer, Stored};
use crate::call::{Call, Heard, Stoppable};
use crate::records::Records;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::sync::Arc;
use switchback::cmd::gap;
use switchback::cmd::power::{PowerArgs, artefacts, plan};
use switchback_io::diagnosis::GivenModel;
use switchback_lab::power::{Context, json, measure, words};

/// Which effects these records would have shown. `asked` are words of a diagnosis, `more` are those of `--power`.
#[pyfunction]
#[pyo3(signature = (records, asked, more, model=None, heard=None))]
pub(crate) fn power(
    py: Python<'_>,
    records: &Records,
    asked: Vec<OsString>,
    more: Vec<OsString>,
    model: Option<Model>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    Call::run(py, &heard, move |call| {
        let Options::<gap::Asked> { asked, threads } = options(asked)?;
        let power: PowerArgs = options(more)?;
        let plan = plan(&power, &asked.settings())?;
        let model = match (&model, asked.model()) {
            (Some((path, text)), _) => Some(GivenModel::of_text(path, text)?),
            (None, path) => path.map(GivenModel::read).transpose()?,
        };
        let place = about.place.display().to_string();
        // What is found is reported with the ground that it was found on, which borrows the rig.
        let measured = threads.install(|| {
            let context = Context::new(&rig, model, asked.settings(), &place)?;
            let power = measure(&context, &plan, &Stoppable(call), || {})?;
            let (json, words) = (json(&power, &context), words(&power, &context));
            Ok::<_, Refusal>(Stored::new(json, words, artefacts(&power, &context)).reading(about.inputs))
        });
        Ok(Answer::new(measured??))
    })
}
