//! Weak points of an identification, reported rather than hidden.

use crate::statistics::normal_quantile_975;
use crate::{BorderDistance, Coefficient, PlusMinus};
use std::fmt;
use switchback_model::hysteresis::Branch;
use switchback_model::stray::{SignalName, StraySample};

/// Something that limits what the result can be trusted with.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Samples far from all others of their signal were replaced by straight lines.
    StraySamples {
        /// The first one.
        first: StraySample,
        /// How many there are.
        count: usize,
    },
    /// The sensor of `v` is noisy; smaller reversals were ignored.
    SensorNoise {
        /// Reversal threshold in force, input units.
        threshold: f64,
    },
    /// If the fast part of the input is noise of its sensor, it moves an estimate by so much that intervals hold the truth in less than 90 % of all cases.
    InputNoise {
        /// Standard deviation of the noise, input units.
        sd: f64,
        /// `sd` over the width of the working interval.
        share: f64,
        /// The largest shift, in standard errors of what is moved.
        errors: f64,
    },
    /// So few reversals that the borders are hardly distinguished from a trend.
    FewReversals {
        /// Reversals in all records.
        count: usize,
    },
    /// All records repeat one stroke at one speed.
    OneStroke {
        /// From one turning point to the next, input units.
        length: f64,
        /// Samples that it takes.
        samples: f64,
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
    /// The normal equations lose half of the digits of the arithmetic, or all of them.
    IllConditioned {
        /// Condition number of the information matrix with columns scaled to one; infinite if a parameter has no information.
        condition: f64,
    },
    /// Nowhere do the two borders differ beyond their errors.
    LoopVanished {
        /// How far they lie apart.
        distance: BorderDistance,
    },
    /// No coefficient that looks ahead is distinguished from zero.
    LeadNotReported {
        /// Lag of the one most clearly reported, negative.
        lag: isize,
        /// Its value, output units.
        value: f64,
        /// Its standard error.
        se: f64,
    },
    /// `A(1)` or `B(1)` is not distinguished from zero, so neither are the gain and the levels that follow from it.
    GainNotReported {
        /// `A` or `B`.
        polynomial: char,
        /// Its value at 1.
        value: f64,
        /// Its standard error.
        se: f64,
    },
    /// A coefficient larger than the whole of its polynomial at 1 is not distinguished from zero.
    CarrierNotReported {
        /// The coefficient.
        coefficient: Coefficient,
        /// The polynomial at 1.
        sum: f64,
    },
}

/// A value with its 95 % interval.
fn interval(value: f64, se: f64) -> PlusMinus {
    PlusMinus::new(value, normal_quantile_975() * se)
}

impl Warning {
    /// One word for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::StraySamples { .. } => "stray_samples",
            Self::SensorNoise { .. } => "sensor_noise",
            Self::InputNoise { .. } => "input_noise",
            Self::FewReversals { .. } => "few_reversals",
            Self::OneStroke { .. } => "one_stroke",
            Self::SteepCell { .. } => "steep_cell",
            Self::RarelyVisited { .. } => "rarely_visited",
            Self::SpanIllDefined => "span_ill_defined",
            Self::NegativeGain => "negative_gain",
            Self::NoStationaryGain => "no_stationary_gain",
            Self::LooksAhead { .. } => "looks_ahead",
            Self::IllConditioned { .. } => "ill_conditioned",
            Self::LoopVanished { .. } => "loop_vanished",
            Self::LeadNotReported { .. } => "look_ahead_not_told",
            Self::GainNotReported { .. } => "gain_not_told",
            Self::CarrierNotReported { .. } => "coefficient_not_told",
        }
    }

    /// The figure that decided: a threshold, a count, a share, or how many standard errors a number lies from zero or is moved.
    pub fn figure(&self) -> Option<f64> {
        match *self {
            Self::SensorNoise { threshold } => Some(threshold),
            Self::InputNoise { errors, .. } => Some(errors),
            Self::StraySamples { count, .. } | Self::FewReversals { count } => Some(count as f64),
            Self::OneStroke { length, .. } => Some(length),
            Self::SteepCell { share, .. } => Some(share),
            Self::RarelyVisited { samples, .. } | Self::LooksAhead { samples } => Some(samples as f64),
            Self::IllConditioned { condition } => Some(condition),
            Self::LoopVanished { distance } => Some(distance.z),
            Self::LeadNotReported { value, se, .. }
            | Self::GainNotReported { value, se, .. }
            | Self::CarrierNotReported { coefficient: Coefficient { value, se, .. }, .. } => {
                Some(value.abs() / se)
            }
            Self::SpanIllDefined | Self::NegativeGain | Self::NoStationaryGain => None,
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |curve: &Branch| match curve {
            Branch::Ascending => "ascending",
            Branch::Descending => "descending",
        };
        match self {
            Self::StraySamples { first: StraySample { record, sample, signal, value }, count } => {
                let signal = match signal {
                    SignalName::Input => "input",
                    SignalName::Output => "output",
                };
                let place =
                    format!("record {}, sample {}: the {signal} is {value:.4e}", record + 1, sample + 1);
                let others = match count - 1 {
                    0 => String::new(),
                    more => format!(" and {more} more like it"),
                };
                write!(
                    out,
                    "{place}, far from all other values; it{others} was replaced by a straight line between its neighbours"
                )
            }
            Self::SensorNoise { threshold } => {
                write!(out, "the input is noisy: reversals smaller than {threshold:.3e} were taken as noise")
            }
            Self::InputNoise { sd, share, errors } => write!(
                out,
                "the fast part of the input (sd {sd:.3e}, {:.2} % of the interval), if it is noise of the sensor, moves a coefficient or a border point by roughly {errors:.1} standard errors, which the intervals do not allow for; longer records do not help, a less noisy sensor does, or the mean of several readings in each sample",
                100.0 * share
            ),
            Self::FewReversals { count: 0 } => write!(
                out,
                "the input never turns: one border is visited, and the other is not identified; record a motion to and fro"
            ),
            Self::FewReversals { count } => write!(
                out,
                "only {count} reversals in all records: a loop is hardly distinguished from a trend; record more strokes to and fro"
            ),
            Self::OneStroke { length, samples } => write!(
                out,
                "the input repeats one stroke of {length:.4} in {samples:.0} samples: another linear part with other borders gives the same output, so that neither order and poles nor borders are identified; add a record of this stroke at half the speed, and one of shorter strokes"
            ),
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
            Self::IllConditioned { condition } if condition.is_finite() => write!(
                out,
                "the regression is ill-conditioned (condition number {condition:.1e}, where 6.7e7 costs half of the digits): single coefficients mean little, only the model as a whole; give a lower order or richer records"
            ),
            Self::IllConditioned { .. } => write!(
                out,
                "the regression is singular: the records leave a parameter open, so the coefficients and their errors mean nothing, only the model as a whole; give a lower order or richer records"
            ),
            Self::LoopVanished { distance } => {
                let BorderDistance { clearest, z, limit, places, .. } = distance;
                let percent =
                    PlusMinus::new(100.0 * clearest.difference, 100.0 * normal_quantile_975() * clearest.se);
                write!(
                    out,
                    "the loop vanished: over the whole stroke ({places} places) the borders do not differ beyond their errors; the clearest difference, at {:.4}, is ({percent}) % of u_M − u_m, {z:.1} standard errors where {limit:.1} would show",
                    clearest.v
                )
            }
            Self::LeadNotReported { lag, value, se } => write!(
                out,
                "the look-ahead term b{lag} = {} is not distinguished from zero: a model that needs no look ahead says as much",
                interval(*value, *se)
            ),
            Self::GainNotReported { polynomial: 'A', value, se } => write!(
                out,
                "A(1) = {} is not distinguished from zero: the model may as well integrate, so its gain and the outputs it holds, y_high and y_low, have no bounds",
                interval(*value, *se)
            ),
            Self::GainNotReported { polynomial, value, se } => write!(
                out,
                "{polynomial}(1) = {} is not distinguished from zero: its coefficients cancel, so neither the sign of the gain nor the common level of the borders is known",
                interval(*value, *se)
            ),
            Self::CarrierNotReported { coefficient: Coefficient { letter, lag, value, se }, sum } => write!(
                out,
                "{letter}{lag} = {} is not distinguished from zero, yet it is larger than {}(1) = {sum:.3e}, all that remains when the coefficients are added up: give a lower order or richer records",
                interval(*value, *se),
                letter.to_ascii_uppercase()
            ),
        }
    }
}
