//! A fitted parameter of an effect.

/// One fitted parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedParameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit in words, e.g. `samples` or `input units`.
    pub unit: &'static str,
    /// The estimate.
    pub value: f64,
    /// Its 90 % interval; NaN where the likelihood gives none.
    pub ci90: [f64; 2],
}
