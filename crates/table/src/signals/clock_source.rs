//! Where a sample time comes from.

use super::resample::Resampled;

/// Where the sample time comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum ClockSource {
    /// The user, who has no time column.
    Given,
    /// A line above the table.
    Stated,
    /// A column that counts the samples, beside stamps that came late.
    Counted,
    /// The user; the time column agrees.
    GivenAndTime,
    /// The time column, whose steps differ from it by up to this share.
    Time {
        /// Largest difference of a step, as a share of the sample time.
        jitter: f64,
    },
    /// The rows were interpolated.
    Resampled(Resampled),
}
