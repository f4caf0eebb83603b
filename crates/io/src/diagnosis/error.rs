//! Why a rig that could be read could not be diagnosed.

use miette::Diagnostic;
use std::path::Path;
use switchback_diagnose::DiagnoseError;
use thiserror::Error;

/// What the diagnosis refused, and what to do about it.
#[derive(Debug, Error, Diagnostic)]
#[error("{rig}: {problem}")]
#[diagnostic(help("{remedy}"))]
pub struct DiagnosisError {
    /// The rig's name, or its file where that is known.
    rig: String,
    problem: String,
    remedy: String,
}

impl DiagnosisError {
    pub(super) fn new(rig: &str, error: &DiagnoseError) -> Self {
        let reported = error.to_string();
        // These errors name the remedy after the last semicolon.
        let (problem, remedy) =
            reported.rsplit_once("; ").unwrap_or((&reported, "check the records of the rig"));
        let remedy = match error {
            DiagnoseError::TooShort { order: 1, .. } => "record longer",
            DiagnoseError::TooShort { .. } => {
                "record longer, or set a lower `order` in a rig file, as `switchback init` writes one"
            }
            _ => remedy,
        };
        Self { rig: rig.to_owned(), problem: problem.to_owned(), remedy: remedy.to_owned() }
    }

    /// Names the rig by its file, which a message should lead to.
    pub fn in_file(mut self, file: &Path) -> Self {
        self.rig = file.display().to_string();
        self
    }
}
