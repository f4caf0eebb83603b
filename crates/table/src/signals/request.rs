//! What is asked of a file.

use super::input_form::InputForm;
use super::names::{ColumnNames, Sampling};

/// What is asked of a file.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// Names of columns, where the user gave them.
    pub names: &'a ColumnNames,
    /// How rows become samples.
    pub sampling: Sampling,
    /// Who asks.
    pub input_form: &'a InputForm,
    /// Whether there must be an output.
    pub needs_output: bool,
}
