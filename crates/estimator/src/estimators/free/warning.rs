//! Weak points of an identification, told rather than hidden.

use super::basis::Basis;
use super::normalise::{Span, has_gain};
use super::problem::{Parameters, Structure};
use super::sensor::SensorNoise;
use crate::hysteresis::Branch;
use std::fmt;

/// Something that limits what the result can be trusted with.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The sensor of `v` is noisy; smaller reversals were ignored.
    SensorNoise {
        /// Reversal threshold in force, input units.
        threshold: f64,
    },
    /// So few reversals that the borders are hardly told from a trend.
    FewReversals {
        /// Reversals in all records.
        count: usize,
    },
    /// Half of a curve's range or more lies between two neighbouring knots: a jump, or too coarse a grid.
    SteepCell {
        /// Which curve.
        curve: Branch,
        /// The knots on its two sides, input units.
        between: (f64, f64),
        /// Its share of the curve's range.
        share: f64,
    },
    /// Few samples determine the value at a knot.
    RarelyVisited {
        /// Which curve.
        curve: Branch,
        /// Position of the knot, input units.
        v: f64,
        /// Samples in the cells beside it.
        samples: usize,
    },
    /// `u_M − u_m` vanishes beside the range of the curves, which was set to one instead.
    SpanIllDefined,
    /// `u_M − u_m` and `B(1)` are both reversed in sign: the stationary output falls from `h_m` to `h_M`.
    NegativeGain,
    /// `B(1)` vanishes: the level of `u` is unknown, and the border values count from `u_m`.
    NoStationaryGain,
    /// The output answers to `v` before `v` shows; a real-time simulation would need `v` in advance.
    LooksAhead {
        /// By how many samples.
        samples: usize,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |curve: &Branch| match curve {
            Branch::Ascending => "ascending",
            Branch::Descending => "descending",
        };
        match self {
            Self::SensorNoise { threshold } => {
                write!(out, "the input is noisy: reversals smaller than {threshold:.3e} were taken as noise")
            }
            Self::FewReversals { count } => write!(out, "only {count} reversals in all records"),
            Self::SteepCell { curve, between: (low, high), share } => write!(
                out,
                "{:.0} % of the {} border's range lies between its knots {low:.4} and {high:.4}: a jump, or too few knots",
                100.0 * share,
                name(curve)
            ),
            Self::RarelyVisited { curve, v, samples } => {
                write!(out, "only {samples} samples lie beside the knot {v:.4} of the {} border", name(curve))
            }
            Self::SpanIllDefined => {
                write!(
                    out,
                    "u_M and u_m coincide; the range of the curves is set to one instead of their difference"
                )
            }
            Self::NegativeGain => {
                write!(out, "the stationary output falls from h_m to h_M: the gain is negative")
            }
            Self::NoStationaryGain => {
                write!(out, "B(1) vanishes: border values count from u_m, their common level is unknown")
            }
            Self::LooksAhead { samples } => {
                write!(
                    out,
                    "the output leads the input by {samples} sample(s): the sensor of v lags, or y is filtered both ways"
                )
            }
        }
    }
}

/// A knot with fewer samples beside it than this is reported.
const FEW_SAMPLES: usize = 10;
/// Share of the working interval up to which a threshold is that of rounding in arithmetic.
const ROUNDING: f64 = 1e-12;
/// Fewer reversals than this are reported.
const FEW_REVERSALS: usize = 4;

/// What the fit has to say against itself.
#[derive(Debug)]
pub(super) struct Examination<'a> {
    pub(super) basis: &'a Basis,
    pub(super) structure: Structure,
    pub(super) theta: &'a Parameters,
    pub(super) noise: SensorNoise,
    pub(super) threshold: f64,
    /// Width of the working interval.
    pub(super) range: f64,
    pub(super) reversals: usize,
    /// Samples in the cells beside each knot.
    pub(super) visits: Vec<usize>,
}

impl Examination<'_> {
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let mut found = Vec::new();
        // The last digits of a computed input are no news.
        if self.noise.threshold > ROUNDING * self.range {
            found.push(Warning::SensorNoise { threshold: self.threshold });
        }
        if self.basis.is_switched() && self.reversals < FEW_REVERSALS {
            found.push(Warning::FewReversals { count: self.reversals });
        }
        let lead = self.structure.ahead();
        if lead > 0 {
            found.push(Warning::LooksAhead { samples: lead });
        }
        if !Span::of(&self.theta.f).is_papers {
            found.push(Warning::SpanIllDefined);
        }
        if !has_gain(self.theta) {
            found.push(Warning::NoStationaryGain);
        } else if self.theta.b.iter().sum::<f64>() * Span::of(&self.theta.f).value < 0.0 {
            found.push(Warning::NegativeGain);
        }
        self.curves(&mut found);
        found
    }

    /// Steep cells and rarely visited knots, curve by curve. A straight line has neither.
    fn curves(&self, found: &mut Vec<Warning>) {
        let value = |k: usize| if k == 0 { 0.0 } else { self.theta.f[k - 1] };
        let curves =
            [(Branch::Descending, self.basis.descending()), (Branch::Ascending, self.basis.ascending())];
        let mut first = 0;
        for (curve, knots) in curves.into_iter().take(self.basis.sizes().count()) {
            let values: Vec<f64> = (first..first + knots.len()).map(value).collect();
            let (low, high) =
                values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
            for j in 1..knots.len() {
                let share = (values[j] - values[j - 1]).abs() / (high - low).max(f64::MIN_POSITIVE);
                if knots.len() > 4 && share > 0.5 {
                    found.push(Warning::SteepCell { curve, between: (knots[j - 1], knots[j]), share });
                }
            }
            for (j, &v) in knots.iter().enumerate() {
                let samples = self.visits[first + j];
                if samples < FEW_SAMPLES {
                    found.push(Warning::RarelyVisited { curve, v, samples });
                }
            }
            first += knots.len();
        }
    }
}
