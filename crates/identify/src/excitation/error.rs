//! Why an experiment is refused.

use super::Direction;
use thiserror::Error;

/// Why a designed experiment is refused.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ExcitationError {
    /// No level to visit.
    #[error(
        "the experiment has no level to visit; give at least one, the end of the interval opposite the satellite"
    )]
    NoLevels,
    /// The linear part has order zero.
    #[error("order = 0: the linear part needs an order of at least 1")]
    ZeroOrder,
    /// The spacing is zero.
    #[error(
        "spacing = 0: the period has no samples; give at least 1, and max(order, 2) to keep the memory masked"
    )]
    ZeroSpacing,
    /// A level is NaN, infinite, or outside the working interval.
    #[error(
        "level {number} is {value}, outside the working interval [{low}, {high}]; move the level or widen the interval"
    )]
    OutsideInterval {
        /// Number of the level, from 1.
        number: usize,
        /// The level given.
        value: f64,
        /// `h_m`.
        low: f64,
        /// `h_M`.
        high: f64,
    },
    /// A level is the satellite itself, so that visiting it moves nothing.
    #[error(
        "level {number} is the satellite {value} of the {direction} experiment: the input would not move and u would \
         keep its value; drop this level"
    )]
    AtSatellite {
        /// Number of the level, from 1.
        number: usize,
        /// The level given.
        value: f64,
        /// Which experiment.
        direction: Direction,
    },
    /// The first level is not the end of the interval opposite the satellite, which fixes the normalisation.
    #[error(
        "level 1 is {value}, but a {direction} experiment visits {expected} first: u there fixes the normalisation \
         u_M − u_m = 1; put {expected} in front"
    )]
    FirstLevel {
        /// The level given.
        value: f64,
        /// The end of the interval opposite the satellite.
        expected: f64,
        /// Which experiment.
        direction: Direction,
    },
    /// Two neighbouring levels are equal or in the wrong order.
    #[error(
        "level {number} is {value} after {previous}: the levels of a {direction} experiment must strictly {} from the \
         end of the interval towards the satellite; sort them and drop repetitions",
        match direction { Direction::Descendant => "increase", Direction::Ascendant => "decrease" }
    )]
    NotOrdered {
        /// Number of the level, from 1.
        number: usize,
        /// The level given.
        value: f64,
        /// The level before it.
        previous: f64,
        /// Which experiment.
        direction: Direction,
    },
    /// A setting of a random drive is out of its range.
    #[error("{setting} = {value}: {remedy}")]
    DriveSetting {
        /// Name of the setting.
        setting: &'static str,
        /// The value given.
        value: f64,
        /// What would be accepted.
        remedy: &'static str,
    },
    /// A pulse experiment of too few periods.
    #[error(
        "periods = {periods}: one period settles the output and every level must come back at least once more; use at \
         least {minimum}"
    )]
    TooFewPeriods {
        /// Periods given.
        periods: usize,
        /// The fewest allowed.
        minimum: usize,
    },
}
