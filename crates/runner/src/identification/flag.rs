//! What the reader must know before trusting a figure.

use switchback_estimator::estimators::free::Warning;

/// One reservation about an identification, in words and for programs.
#[derive(Debug, Clone, PartialEq)]
pub struct Flag {
    /// One word for programs, the same for every flag of its kind.
    pub kind: &'static str,
    /// The figure that decided, where there is one; [`Flag::text`] says which it is.
    pub figure: Option<f64>,
    /// One sentence.
    pub text: String,
}

impl Flag {
    /// A flag with its figure.
    pub(super) fn new(kind: &'static str, figure: f64, text: String) -> Self {
        Self { kind, figure: Some(figure), text }
    }
}

impl From<&Warning> for Flag {
    fn from(warning: &Warning) -> Self {
        Self { kind: warning.kind(), figure: warning.figure(), text: warning.to_string() }
    }
}
