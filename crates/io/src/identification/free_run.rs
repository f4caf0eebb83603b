//! A simulation of one record.

use switchback_identify::free::fit_percent;

/// An identified system's simulation of one record, from the record's `v` alone once it has started.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeRun {
    /// One output a sample, output units; the measured ones before `start`.
    pub simulated: Vec<f64>,
    /// First sample that is simulated; those before it are the initial state.
    pub start: usize,
    /// [`fit_percent`] from `start` on.
    pub fit_percent: f64,
}

impl FreeRun {
    /// Judges a simulation against the measured output.
    pub(crate) fn new(measured: &[f64], simulated: Vec<f64>, start: usize) -> Self {
        let fit_percent = fit_percent(&measured[start..], &simulated[start..]);
        Self { simulated, start, fit_percent }
    }
}
