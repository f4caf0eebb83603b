//! `switchback export`

use super::{Model, options};
use crate::call::{Call, Heard};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::ffi::OsString;
use std::path::PathBuf;
use switchback::cmd::export::{Asked, made};
use switchback_io::model;

/// The bytes of a model as a C header or an FMU; `out` is the file that they are meant for.
#[pyfunction]
#[pyo3(signature = (model, words, out=None, heard=None))]
pub(crate) fn export<'py>(
    py: Python<'py>,
    model: Model,
    words: Vec<OsString>,
    out: Option<PathBuf>,
    heard: Heard<'py>,
) -> PyResult<Bound<'py, PyBytes>> {
    let made = Call::run(py, &heard, move |_| {
        let (path, text) = model;
        let asked: Asked = options(words)?;
        let file = model::of_text(&path, &text)?;
        let name = asked.name(&file, out.as_deref());
        Ok(made(&file, &asked, (&path, &name))?)
    })?;
    Ok(PyBytes::new(py, &made))
}
