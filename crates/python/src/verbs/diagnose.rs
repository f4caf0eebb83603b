//! `switchback gap`

use super::Model;
use crate::answer::{Answer, Page};
use crate::call::{Call, Heard};
use crate::options::Options;
use crate::records::Records;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use switchback_diagnose::Effect;
use switchback_diagnose::posterior::Posterior;
use switchback_io::diagnosis::{
    DiagnosisError, GivenModel, NoPosterior, Report, Request, Subject, examine_watched, posterior, prior,
    stability,
};
use switchback_io::model;
use switchback_io::output::Artefacts;
use switchback_io::values::whole;
use switchback_report::diagnosis as text;

/// Diagnoses the gap between a model and the records, or what differs from other records.
#[pyfunction]
#[pyo3(signature = (records, options, model=None, against=None, heard=None))]
pub(crate) fn diagnose(
    py: Python<'_>,
    records: &Records,
    mut options: Options,
    model: Option<Model>,
    against: Option<&Records>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    let against = against.map(|other| Arc::clone(&other.rig));
    Call::run(py, &heard, move |call| {
        let settings = request(&mut options)?.settings();
        let threads = options.threads()?;
        let samples = options.value("--stability <SAMPLES>", whole(1..=1000))?;
        options.finish()?;
        let model = model.map(|(path, text)| GivenModel::of_text(&path, &text)).transpose()?;
        let rig = Arc::unwrap_or_clone(rig);
        let subject = match &against {
            Some(other) => Subject::against(rig, other)?,
            None => Subject::of(rig, model.as_ref())?,
        };
        let subject = subject.noting(about.warnings);
        let report = threads.install(|| {
            let asked = samples.map(|samples| (subject.clone(), samples));
            let mut report = examine_watched(subject, &settings, &*call)?;
            report.stability =
                asked.map(|(subject, samples)| stability(&subject, &settings, (&report, samples), &*call));
            Ok(report)
        })?;
        let report = report.map_err(|error: DiagnosisError| error.in_file(&about.place))?;
        Ok(Answer::new(Diagnosed { report, inputs: about.inputs }))
    })
}

/// What is asked of a diagnosis.
pub(super) fn request(options: &mut Options) -> Result<Request, Refusal> {
    let name = |effect: &Effect| effect.name();
    Ok(Request {
        without: options.names("--without <EFFECT>", &Effect::ALL, name)?,
        ask: options.names("--ask <EFFECT>", &Effect::ALL, name)?,
        causal: options.switch("--causal")?,
        prior: options.value("--prior <SHARES>", prior)?,
        posterior: options.value("--posterior <POSTERIOR.bin>", of_file)?.map(Arc::new),
    })
}

fn of_file(path: &str) -> Result<Posterior, NoPosterior> {
    posterior(Path::new(path))
}

#[derive(Debug)]
struct Diagnosed {
    report: Report,
    inputs: Vec<PathBuf>,
}

impl Page for Diagnosed {
    fn json(&self) -> String {
        text::json(&self.report)
    }

    fn words(&self) -> String {
        text::words(&self.report, None)
    }

    fn files(&self) -> Result<Artefacts, Refusal> {
        Ok(text::artefacts(&self.report)?)
    }

    fn texts(&self) -> BTreeMap<String, String> {
        let models = model::diagnosed(&self.report).into_iter();
        let models = models.map(|(name, model)| (name.to_owned(), model.text()));
        let others =
            [("series.csv", model::diagnosed_series(&self.report).text()), ("why", text::why(&self.report))];
        models.chain(others.map(|(name, text)| (name.to_owned(), text))).collect()
    }

    fn inputs(&self) -> &[PathBuf] {
        &self.inputs
    }
}
