//! What the user may fix, and what is otherwise chosen from the data.

use super::error::FreeError;
use switchback_model::hysteresis::Interval;
use switchback_model::reversal::Timing;

/// How the input enters the linear part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum InputMap {
    /// `u` runs on two borders and switches at reversals: the `free` method.
    Borders,
    /// `u` is one static curve of `v`: the `memoryless` baseline, a Hammerstein fit without hysteresis.
    Static,
    /// `u = v` and a constant: the `linear-arx` baseline.
    Linear,
}

/// Choices of an identification; `None` leaves a choice to cross-validation (or to the data).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How the input enters.
    pub input_map: InputMap,
    /// Order `n` of the linear part, at least 1.
    pub order: Option<usize>,
    /// Extra whole samples of delay, as in [`crate::Estimate::delay`]: −1 lets `B` act on `u(t)` itself.
    pub delay: Option<isize>,
    /// Knots of each curve, at least 2; ignored by [`InputMap::Linear`].
    pub knots: Option<usize>,
    /// Reversal threshold, input units.
    pub threshold: Option<f64>,
    /// Whether reversals take effect at samples or between them.
    pub timing: Option<Timing>,
    /// Working interval; the range of the records otherwise.
    pub interval: Option<Interval>,
    /// Whether the model must be able to run in real time: `y(t)` from `v` up to `t` alone. A direct term (delay −1) may stay, no lag may
    /// be negative, and a reversal takes effect once it is confirmed ([`Timing::AtConfirmation`], whatever `timing` says).
    pub causal: bool,
    /// Whether to minimise the simulation error after the equation error.
    pub refine: bool,
    /// Whether the final estimate of a refined fit models the colour of the noise, where that contradicts no fit without; the model is the same.
    pub whiten: bool,
    /// Whether standard errors allow for what a grid of knots cannot follow, at the cost of fits on finer grids; the model is the same.
    pub undersmooth: bool,
    /// Whether it is worked out by how much noise found on the input moves the estimate, at the cost of fits to simulated records; model and estimate
    /// are the same.
    pub input_noise: bool,
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
            timing: None,
            interval: None,
            causal: false,
            refine: true,
            whiten: true,
            undersmooth: true,
            input_noise: true,
        }
    }

    /// Whether a model of this delay may be chosen: a delay below −1 weighs samples of `v` that lie ahead.
    pub(super) fn allows(&self, delay: isize) -> bool {
        !self.causal || delay >= -1
    }

    /// Refuses what makes no sense.
    pub(super) fn check(&self) -> Result<(), FreeError> {
        let refuse = |name, value, allowed| Err(FreeError::Setting { name, value, allowed });
        match *self {
            Self { order: Some(n), .. } if !(1..=20).contains(&n) => {
                refuse("order", n as f64, "from 1 to 20")
            }
            Self { delay: Some(d), .. } if d < -20 => refuse("delay", d as f64, "-20 or more"),
            Self { delay: Some(d), .. } if !self.allows(d) => {
                refuse("delay", d as f64, "-1 or more in a causal model")
            }
            Self { knots: Some(k), .. } if !(2..=200).contains(&k) => {
                refuse("knots", k as f64, "from 2 to 200")
            }
            Self { threshold: Some(x), .. } if !(x.is_finite() && x >= 0.0) => {
                refuse("threshold", x, "finite and not negative")
            }
            _ => Ok(()),
        }
    }
}
