//! What is wrong, in the words of the command line.

use miette::Diagnostic;
use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, create_exception};
use switchback_io::output::plain;

create_exception!(
    switchback,
    SwitchbackError,
    PyValueError,
    "Something that was given cannot be used; the message is that of the command line, with the remedy."
);

/// The words of a refusal.
#[derive(Debug)]
pub(crate) struct Refusal(String);

impl<E: Into<miette::Report>> From<E> for Refusal {
    fn from(error: E) -> Self {
        let report: miette::Report = error.into();
        let diagnostic: &dyn Diagnostic = report.as_ref();
        Self(without_heading(&plain(diagnostic)))
    }
}

impl Refusal {
    /// What the command line says to words that it does not understand.
    pub(crate) fn of_words(error: &clap::Error) -> Self {
        let reported = error.render().to_string();
        // What follows shows how to ask a command line for help.
        let reported = reported.split("\n\nUsage:").next().unwrap_or_default();
        Self(without_heading(reported.split("\n\nFor more information").next().unwrap_or_default()))
    }
}

impl From<Refusal> for PyErr {
    fn from(Refusal(words): Refusal) -> Self {
        SwitchbackError::new_err(words)
    }
}

fn without_heading(words: &str) -> String {
    words.strip_prefix("error: ").unwrap_or(words).trim_end().to_owned()
}
