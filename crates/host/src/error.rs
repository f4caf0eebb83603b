//! Why an FMU did not run.

use miette::Diagnostic;
use std::path::Path;
use thiserror::Error;

/// What went wrong, where, and what to do about it.
#[derive(Debug, Error, Diagnostic)]
#[error("{file}: {what}")]
#[diagnostic(help("{remedy}"))]
pub struct FmuError {
    file: String,
    pub(crate) what: String,
    pub(crate) remedy: String,
}

impl FmuError {
    pub(crate) fn new(file: &Path, what: impl ToString, remedy: impl ToString) -> Self {
        Self { file: file.display().to_string(), what: what.to_string(), remedy: remedy.to_string() }
    }
}
