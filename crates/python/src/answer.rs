//! What a verb found.

use crate::refusal::Refusal;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use switchback_io::output::{Artefacts, OutputFolder};

/// What a verb has to say, made when it is asked for.
pub(crate) trait Page: fmt::Debug + Send + Sync {
    /// The object that `--json` prints, to the last byte.
    fn json(&self) -> String;

    /// What the command line prints without it.
    fn words(&self) -> String;

    /// The files that `--out` writes.
    ///
    /// # Errors
    /// A file that cannot be made.
    fn files(&self) -> Result<Artefacts, Refusal>;

    /// Other texts by their names.
    fn texts(&self) -> BTreeMap<String, String> {
        BTreeMap::new()
    }

    /// Files that were read and must not be replaced.
    fn inputs(&self) -> &[PathBuf] {
        &[]
    }
}

/// What a verb found: the JSON object of the command line, its words, the files of its report.
#[pyclass(frozen, module = "switchback._native")]
pub struct Answer(Arc<dyn Page>);

impl Answer {
    pub(crate) fn new(page: impl Page + 'static) -> Self {
        Self(Arc::new(page))
    }
}

#[pymethods]
impl Answer {
    /// An answer that was taken apart before.
    #[new]
    #[expect(clippy::needless_pass_by_value, reason = "arguments from Python come by value")]
    fn stored(
        json: String,
        words: String,
        files: BTreeMap<String, Vec<u8>>,
        texts: BTreeMap<String, String>,
        inputs: Vec<PathBuf>,
    ) -> Self {
        let mut artefacts = Artefacts::default();
        for (name, contents) in &files {
            artefacts.add(name.as_str(), contents.as_slice());
        }
        Self::new(Stored { texts, ..Stored::new(json, words, artefacts) }.reading(inputs))
    }

    /// The object that `--json` prints, to the last byte.
    #[getter]
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| self.0.json())
    }

    /// What the command line prints.
    #[getter]
    fn words(&self, py: Python<'_>) -> String {
        py.detach(|| self.0.words())
    }

    /// Other texts by their names.
    #[getter]
    fn texts(&self, py: Python<'_>) -> BTreeMap<String, String> {
        py.detach(|| self.0.texts())
    }

    /// The files that `--out` writes, by their names.
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let files = py.detach(|| self.0.files())?;
        let by_name = PyDict::new(py);
        for (name, contents) in files.iter() {
            by_name.set_item(name, PyBytes::new(py, contents))?;
        }
        Ok(by_name)
    }

    /// Writes them into a folder: all of them, or none.
    fn save(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<()> {
        py.detach(|| {
            let files = self.0.files()?;
            let names: Vec<&str> = files.iter().map(|(name, _)| name).collect();
            let inputs = self.0.inputs().iter().map(PathBuf::as_path);
            OutputFolder::claim(&folder, force)?.expecting(&names)?.sparing(inputs)?.commit(&files)?;
            Ok::<_, Refusal>(())
        })?;
        Ok(())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let inputs: Vec<&Path> = self.0.inputs().iter().map(PathBuf::as_path).collect();
        let inputs: Vec<&str> = inputs
            .into_iter()
            .map(|path| path.to_str().ok_or_else(|| PyOSError::new_err("a path is no text")))
            .collect::<PyResult<_>>()?;
        let parts = (self.json(py), self.words(py), self.files(py)?, self.texts(py), inputs);
        Ok((py.get_type::<Self>().into_any(), parts.into_pyobject(py)?))
    }
}

/// An answer as its parts.
#[derive(Debug)]
pub(crate) struct Stored {
    json: String,
    words: String,
    files: Artefacts,
    texts: BTreeMap<String, String>,
    inputs: Vec<PathBuf>,
}

impl Stored {
    /// An answer whose parts are made.
    pub(crate) fn new(json: String, words: String, files: Artefacts) -> Self {
        Self { json, words, files, texts: BTreeMap::new(), inputs: Vec::new() }
    }

    /// The same with the files that were read for it.
    pub(crate) fn reading(self, inputs: Vec<PathBuf>) -> Self {
        Self { inputs, ..self }
    }
}

impl Page for Stored {
    fn json(&self) -> String {
        self.json.clone()
    }

    fn words(&self) -> String {
        self.words.clone()
    }

    fn files(&self) -> Result<Artefacts, Refusal> {
        Ok(self.files.clone())
    }

    fn texts(&self) -> BTreeMap<String, String> {
        self.texts.clone()
    }

    fn inputs(&self) -> &[PathBuf] {
        &self.inputs
    }
}
