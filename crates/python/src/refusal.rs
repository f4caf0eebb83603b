//! What is wrong, in the words of the command line.

use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, create_exception};
use std::fmt::Display;
use switchback_io::output::{Diagnostic, plain, visible};

create_exception!(
    switchback,
    SwitchbackError,
    PyValueError,
    "Something that was given cannot be used; the message is that of the command line, with the remedy."
);

/// The words of a refusal.
#[derive(Debug)]
pub(crate) struct Refusal(String);

impl Refusal {
    /// A message that has no place and no remedy beside it.
    pub(crate) fn new(message: impl Display) -> Self {
        Self(visible(&message.to_string()).into_owned())
    }
}

impl<E: Diagnostic> From<E> for Refusal {
    fn from(error: E) -> Self {
        let words = plain(&error);
        Self(words.strip_prefix("error: ").unwrap_or(&words).trim_end().to_owned())
    }
}

impl From<Refusal> for PyErr {
    fn from(Refusal(words): Refusal) -> Self {
        SwitchbackError::new_err(words)
    }
}
