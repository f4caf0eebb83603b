//! The file of a posterior.

use crate::input::own;
use miette::Diagnostic;
use std::path::Path;
use switchback_diagnose::posterior::{Posterior, PosteriorError};
use thiserror::Error;

/// A file that holds no posterior which can be asked.
#[derive(Debug, Error, Diagnostic)]
pub enum NoPosterior {
    /// It cannot be read.
    #[error("{file}: cannot be read: {reason}")]
    #[diagnostic(help("give the file that `switchback train --out POSTERIOR.bin` has written"))]
    NotRead {
        /// The file.
        file: String,
        /// Why not.
        reason: String,
    },
    /// It holds something else, or is damaged.
    #[error("{file}: {source}")]
    Bad {
        /// The file.
        file: String,
        /// What is wrong.
        source: PosteriorError,
    },
}

/// Reads a posterior that `switchback train` has trained.
///
/// # Errors
/// [`NoPosterior`] with the file and the reason.
pub fn posterior(file: &Path) -> Result<Posterior, NoPosterior> {
    let shown = || file.display().to_string();
    let bytes = own(file).map_err(|e| NoPosterior::NotRead { file: shown(), reason: e.to_string() })?;
    Posterior::read(&bytes).map_err(|source| NoPosterior::Bad { file: shown(), source })
}
