//! `switchback identify`

use crate::answer::{Answer, Page};
use crate::call::{Call, Heard};
use crate::options::Options;
use crate::records::Records;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use switchback_io::identification::{self, Identification, Method, Request, examined_watched};
use switchback_io::model;
use switchback_io::output::Artefacts;
use switchback_model::rig::Rig;
use switchback_report::identification::artefacts;

/// Identifies the linear part and both borders.
#[pyfunction]
#[pyo3(signature = (records, options, heard=None))]
pub(crate) fn identify(
    py: Python<'_>,
    records: &Records,
    mut options: Options,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    Call::run(py, &heard, move |call| {
        let method = options.name("--method <METHOD>", &Method::ALL, |method| method.name())?;
        let request = Request::new(&rig, method, options.switch("--causal")?);
        let threads = options.threads()?;
        options.finish()?;
        let identification = threads.install(|| examined_watched(&rig, request, &*call))?;
        let identification = identification.map_err(|error| error.in_file(&about.place))?;
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

    fn files(&self) -> Result<Artefacts, Refusal> {
        Ok(artefacts(&self.rig, &self.identification)?)
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
