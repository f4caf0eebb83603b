//! `switchback identify`

use super::{Options, options};
use crate::answer::{Answer, Page};
use crate::call::{Call, Heard};
use crate::records::Records;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use switchback::cmd;
use switchback_io::identification::{self, Identification};
use switchback_io::model;
use switchback_io::output::Artefacts;
use switchback_model::rig::Rig;

/// Identifies the linear part and both borders.
#[pyfunction]
#[pyo3(signature = (records, words, heard=None))]
pub(crate) fn identify(
    py: Python<'_>,
    records: &Records,
    words: Vec<OsString>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    Call::run(py, &heard, move |call| {
        let Options { asked, threads } = options(words)?;
        let identification = cmd::identify::identified(&rig, &asked, (&about.place, threads, &*call))?;
        Ok(Answer::new(Identified { rig, identification, inputs: about.inputs }))
    })
}

#[derive(Debug)]
struct Identified {
    rig: Arc<Rig>,
    identification: Identification,
    inputs: Vec<PathBuf>,
}

impl Page for Identified {
    fn json(&self) -> String {
        identification::json(&self.rig, &self.identification)
    }

    fn words(&self) -> String {
        identification::table(&self.rig, &self.identification)
    }

    fn files(&self) -> miette::Result<Artefacts> {
        cmd::identify::artefacts(&self.rig, &self.identification)
    }

    fn texts(&self) -> BTreeMap<String, String> {
        let model = model::identified(&self.rig, &self.identification);
        let series = model::identified_series(&self.rig, &self.identification).text();
        let model = model.map(|model| ("model.json".to_owned(), model.text()));
        model.into_iter().chain([("series.csv".to_owned(), series)]).collect()
    }

    fn inputs(&self) -> &[PathBuf] {
        &self.inputs
    }
}
