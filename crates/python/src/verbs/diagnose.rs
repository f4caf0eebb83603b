//! `switchback gap`

use super::{Model, Options, options};
use crate::answer::{Answer, Page};
use crate::call::{Call, Heard};
use crate::records::Records;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use switchback::cmd::gap;
use switchback_io::diagnosis::{GivenModel, Report, Subject};
use switchback_io::model;
use switchback_io::output::Artefacts;
use switchback_report::diagnosis as text;

/// Diagnoses the gap between a model and the records.
#[pyfunction]
#[pyo3(signature = (records, words, model=None, heard=None))]
pub(crate) fn diagnose(
    py: Python<'_>,
    records: &Records,
    words: Vec<OsString>,
    model: Option<Model>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    Call::run(py, &heard, move |call| {
        let Options::<gap::Asked> { asked, threads } = options(words)?;
        let rig = Arc::unwrap_or_clone(rig);
        let subject = match model {
            Some((path, text)) => Subject::of(rig, Some(&GivenModel::of_text(&path, &text)?))?,
            None => Subject::choose(rig, asked.model())?,
        };
        let subject = subject.noting(about.warnings);
        let report = gap::diagnosed(subject, &asked, (&about.place, threads, &*call))?;
        Ok(Answer::new(Diagnosed { report, inputs: about.inputs }))
    })
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

    fn files(&self) -> miette::Result<Artefacts> {
        Ok(gap::artefacts(&self.report)?)
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
