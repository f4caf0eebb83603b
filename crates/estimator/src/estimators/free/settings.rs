//! What the user may fix, and what is otherwise chosen from the data.

use crate::hysteresis::Interval;

/// How the input enters the linear part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum InputMap {
    /// `u` runs on two borders and switches at reversals: the `free` method.
    Borders,
    /// `u` is one static curve of `v`: the `memoryless` yardstick, a Hammerstein fit without hysteresis.
    Static,
    /// `u = v` and a constant: the `linear-arx` yardstick.
    Linear,
}

/// Choices of an identification; `None` leaves a choice to cross-validation (or to the data).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How the input enters.
    pub input_map: InputMap,
    /// Order `n` of the linear part, at least 1.
    pub order: Option<usize>,
    /// Extra whole samples of delay, as in [`crate::estimators::Estimate::delay`]: −1 lets `B` act on `u(t)` itself.
    pub delay: Option<isize>,
    /// Knots of each curve, at least 2; ignored by [`InputMap::Linear`].
    pub knots: Option<usize>,
    /// Reversal threshold, input units.
    pub threshold: Option<f64>,
    /// Working interval; the range of the records otherwise.
    pub interval: Option<Interval>,
    /// Whether to minimise the simulation error after the equation error.
    pub refine: bool,
}

impl Settings {
    /// Everything left to the data, with refinement.
    pub fn new(input_map: InputMap) -> Self {
        Self {
            input_map,
            order: None,
            delay: None,
            knots: None,
            threshold: None,
            interval: None,
            refine: true,
        }
    }
}
