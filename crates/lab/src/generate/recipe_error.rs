//! Why nothing was made or put in, reported to whoever asked for it.

use super::{EFFECTS, FOREIGN, MakeError};
use miette::Diagnostic;
use switchback_io::input::closest;
use thiserror::Error;

/// A [`MakeError`] with what may have been meant.
#[derive(Debug, Error, Diagnostic)]
#[error("{error}")]
#[diagnostic(help("{guess}`switchback rig --list` shows every effect with its laws"))]
pub struct RecipeError {
    error: MakeError,
    guess: String,
}

impl From<MakeError> for RecipeError {
    fn from(error: MakeError) -> Self {
        let meant = match &error {
            MakeError::UnknownEffect { name, .. } => closest(name, EFFECTS.into_iter().chain(FOREIGN)),
            _ => None,
        };
        let guess = meant.map_or_else(String::new, |effect| format!("did you mean `{effect}`? "));
        Self { error, guess }
    }
}
