//! The step experiment: hold a satellite.

use super::Direction;
use switchback_model::hysteresis::Interval;

/// The step experiment: after one loading sample at the other end, the input is held at `h_M` or at `h_m`.
///
/// ```text
/// v(−1) = h_m, v(t) = h_M for t ≥ 0, so u(t) = u_M      (high)
/// v(−1) = h_M, v(t) = h_m for t ≥ 0, so u(t) = u_m      (low)
/// ```
///
/// The output settles at `y₀ = B(1)/A(1)·u`, which (3.6) averages.
///
/// ```
/// use switchback_identify::excitation::StepExperiment;
/// use switchback_model::hysteresis::Interval;
/// let interval = Interval::new(-1.0, 1.0)?;
/// assert_eq!(StepExperiment::high(interval).record_input(3), [-1.0, 1.0, 1.0, 1.0]);
/// assert_eq!(StepExperiment::low(interval).record_input(2), [1.0, -1.0, -1.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepExperiment {
    interval: Interval,
    satellite_of: Direction,
}

impl StepExperiment {
    /// Holds `h_M`, the satellite of the descendant experiment.
    pub fn high(interval: Interval) -> Self {
        Self::at_satellite_of(Direction::Descendant, interval)
    }

    /// Holds `h_m`, the satellite of the ascendant experiment.
    pub fn low(interval: Interval) -> Self {
        Self::at_satellite_of(Direction::Ascendant, interval)
    }

    /// Holds the satellite of the given pulse experiment.
    pub fn at_satellite_of(direction: Direction, interval: Interval) -> Self {
        Self { interval, satellite_of: direction }
    }

    /// The level that is held, input units.
    pub(crate) fn satellite(&self) -> f64 {
        self.satellite_of.satellite(self.interval)
    }

    /// The input of a whole record: the loading sample, then `samples` samples at the satellite.
    pub fn record_input(&self, samples: usize) -> Vec<f64> {
        let mut v = vec![self.satellite(); samples + 1];
        v[0] = self.satellite_of.opposite(self.interval);
        v
    }
}
