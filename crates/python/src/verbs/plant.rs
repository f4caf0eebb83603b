//! `switchback plant`

use super::{Model, options};
use crate::answer::{Answer, Stored};
use crate::call::{Call, Heard};
use crate::records::Records;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::sync::Arc;
use switchback::cmd;
use switchback_io::diagnosis::Units;
use switchback_io::{model, rig};

/// Puts a known fault into records; gives what was put in, and the records with it.
#[pyfunction]
#[pyo3(signature = (records, words, model=None, heard=None))]
pub(crate) fn plant(
    py: Python<'_>,
    records: &Records,
    words: Vec<OsString>,
    model: Option<Model>,
    heard: Heard<'_>,
) -> PyResult<(Answer, Records)> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    Call::run(py, &heard, move |_| {
        let asked: cmd::plant::Asked = options(words)?;
        let host_model = match (model, asked.model()) {
            (Some((path, text)), _) => Some((model::of_text(&path, &text)?, path)),
            (None, Some(path)) => Some((model::read(path)?, path.to_owned())),
            (None, None) => None,
        };
        let host_model = host_model.as_ref().map(|(file, path)| (file, path.as_path()));
        let injected = cmd::plant::injected(&rig, &asked, (&about.place, host_model))?;
        let words = cmd::plant::reported(&injected.fault, &Units::of(&injected.rig).output);
        let (json, files) = (cmd::plant::page(&injected.fault), rig::artefacts(&injected.rig));
        let name = injected.rig.name.clone();
        let answer = Answer::new(Stored::new(json, words, files).reading(about.inputs));
        Ok((answer, Records::made(injected.rig, &name)))
    })
}
