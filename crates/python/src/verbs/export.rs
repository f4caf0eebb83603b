//! `switchback export`

use super::Model;
use crate::call::{Call, Heard};
use crate::options::{Options, required};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;
use switchback_io::export::{Request, Target};
use switchback_io::model;

/// The bytes of a model as a C header or an FMU; `library` goes into an FMU; `out` is the file that they are meant for.
#[pyfunction]
#[pyo3(signature = (model, options, library=None, out=None, heard=None))]
pub(crate) fn export<'py>(
    py: Python<'py>,
    model: Model,
    mut options: Options,
    library: Option<PathBuf>,
    out: Option<PathBuf>,
    heard: Heard<'py>,
) -> PyResult<Bound<'py, PyBytes>> {
    let made = Call::run(py, &heard, move |_| {
        let (path, text) = model;
        let to = options.name("--to <TARGET>", &Target::ALL, |target| target.name())?;
        let request =
            Request { to: required("--to <TARGET>", to)?, name: options.text("--name <NAME>")?, library };
        options.finish()?;
        let file = model::of_text(&path, &text)?;
        let name = request.name(&file, out.as_deref());
        Ok(request.export(&file, (&path, &name))?)
    })?;
    Ok(PyBytes::new(py, &made))
}
