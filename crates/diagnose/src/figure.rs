//! A figure with its interval.

/// A figure with its 90 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The estimate.
    pub estimate: f64,
    /// Lower and upper end of the 90 % interval.
    pub ci90: [f64; 2],
}
