//! Why an FMU did not run.

use miette::Diagnostic;
use thiserror::Error;

/// What went wrong, where, and what to do about it.
#[derive(Debug, Error, Diagnostic)]
#[error("{file}: {what}")]
#[diagnostic(help("{remedy}"))]
pub struct FmuError {
    file: String,
    what: String,
    remedy: String,
}

impl FmuError {
    pub(super) fn new(file: &std::path::Path, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), what: what.into(), remedy: remedy.into() }
    }
}
