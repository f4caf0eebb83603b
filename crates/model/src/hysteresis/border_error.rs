//! Why the parameters of a border are refused.

use super::Branch;
use thiserror::Error;

/// Why the parameters of a border are refused.
///
/// Parameters are named as in a scenario: `ascending.slope`, `descending[2].v` (list entries count from 0).
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BorderError {
    /// A parameter is NaN or infinite.
    #[error("{parameter} = {value}: give a finite number")]
    NotFinite {
        /// The parameter's name.
        parameter: String,
        /// The value given.
        value: f64,
    },
    /// A parameter that must not be negative is.
    #[error("{parameter} = {value}: give a number that is not negative")]
    Negative {
        /// The parameter's name.
        parameter: String,
        /// The value given.
        value: f64,
    },
    /// A parameter that must be positive is not.
    #[error("{parameter} = {value}: give a number above zero")]
    NotPositive {
        /// The parameter's name.
        parameter: String,
        /// The value given.
        value: f64,
    },
    /// A list that defines a border is empty.
    #[error("{parameter} is an empty list: give at least one entry")]
    Empty {
        /// The parameter's name.
        parameter: String,
    },
    /// Positions on the input axis are equal or fall.
    #[error(
        "{parameter} = {value} follows {previous}: positions must strictly increase; sort them and drop repetitions"
    )]
    NotIncreasing {
        /// The parameter's name.
        parameter: String,
        /// The value given.
        value: f64,
        /// The value of the entry before.
        previous: f64,
    },
    /// A relay whose levels are equal or swapped.
    #[error(
        "low = {low} is not below high = {high}: the relay would not switch up; swap or change the levels"
    )]
    RelayLevels {
        /// The lower level.
        low: f64,
        /// The upper level.
        high: f64,
    },
    /// Borders that never fall, in a kind whose point is that they do.
    #[error(
        "both borders are monotone: 2π·|amplitude|/wavelength exceeds |slope| in neither (ascending {ascending} against \
         slope {ascending_slope}, descending {descending} against slope {descending_slope}); raise an amplitude, \
         shorten a wavelength, or use straight lines"
    )]
    Monotone {
        /// `2π·|amplitude|/wavelength` of the ascending border.
        ascending: f64,
        /// Slope of the ascending border.
        ascending_slope: f64,
        /// `2π·|amplitude|/wavelength` of the descending border.
        descending: f64,
        /// Slope of the descending border.
        descending_slope: f64,
    },
}

/// Checks that a parameter is finite.
pub(super) fn finite(parameter: &str, value: f64) -> Result<(), BorderError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(BorderError::NotFinite { parameter: parameter.to_owned(), value })
    }
}

/// Checks that the parameters of one border are finite.
pub(super) fn all_finite(branch: Branch, parameters: &[(&str, f64)]) -> Result<(), BorderError> {
    parameters.iter().try_for_each(|&(name, value)| finite(&format!("{branch}.{name}"), value))
}

/// Checks that a list of entries is not empty, each entry finite, and their positions strictly increasing.
///
/// `entry` names an entry's values; the position comes first.
pub(super) fn increasing_entries<E, const K: usize>(
    branch: Branch,
    entries: &[E],
    entry: impl Fn(&E) -> [(&'static str, f64); K],
) -> Result<(), BorderError> {
    if entries.is_empty() {
        return Err(BorderError::Empty { parameter: branch.to_string() });
    }
    let mut previous = f64::NEG_INFINITY;
    for (index, values) in entries.iter().map(entry).enumerate() {
        for (name, value) in values {
            finite(&format!("{branch}[{index}].{name}"), value)?;
        }
        let (name, value) = values[0];
        if value <= previous {
            let parameter = format!("{branch}[{index}].{name}");
            return Err(BorderError::NotIncreasing { parameter, value, previous });
        }
        previous = value;
    }
    Ok(())
}
