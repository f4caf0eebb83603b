//! `switchback design`

use super::options;
use crate::answer::{Answer, Page};
use crate::call::{Call, Heard};
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;
use switchback::cmd::design::{Asked, planned};
use switchback_io::output::Artefacts;
use switchback_study::design::{artefacts, json, words};

/// Plans experiments. `out` is the folder that they are meant for.
#[pyfunction]
#[pyo3(signature = (words, out=None, heard=None))]
pub(crate) fn design(
    py: Python<'_>,
    words: Vec<OsString>,
    out: Option<PathBuf>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    Call::run(py, &heard, move |_| {
        let asked: Asked = options(words)?;
        Ok(Answer::new(Designed(planned(&asked, out.as_deref())?)))
    })
}

#[derive(Debug)]
struct Designed(switchback_study::design::Report);

impl Page for Designed {
    fn json(&self) -> String {
        json(&self.0)
    }

    fn words(&self) -> String {
        words(&self.0)
    }

    fn files(&self) -> miette::Result<Artefacts> {
        Ok(artefacts(&self.0.plan))
    }
}
