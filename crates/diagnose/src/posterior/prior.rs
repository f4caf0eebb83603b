//! How common causes are.

/// How common causes are: shares of all rigs, summing to one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// One of the effects.
    pub effect: f64,
    /// Nothing is missing.
    pub none: f64,
    /// A cause that the library does not have.
    pub none_of_these: f64,
}
