//! What the reader must know before trusting a figure.

use switchback_identify::free::Warning;

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
    /// Whether it says how the records were read rather than what is wrong with the result.
    pub(super) fn is_a_note(&self) -> bool {
        ["sensor_noise", "few_reversals", "steep_cell", "rarely_visited", "order_chosen", "one_border"]
            .contains(&self.kind)
    }

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
