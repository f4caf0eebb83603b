//! A free run and its band.

use crate::identification::FreeRun;
use switchback_identify::statistics::Z95;

/// A free run over an input, output units.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// One output a sample; the measured ones before `start`.
    pub y: Vec<f64>,
    /// Lower end of the 95 % band for a measured output; the measured one before `start`.
    pub low: Vec<f64>,
    /// Upper end.
    pub high: Vec<f64>,
    /// First simulated sample.
    pub start: usize,
    /// The fit figure where outputs were measured.
    pub fit_percent: Option<f64>,
    /// What the reader must know, one sentence each.
    pub notes: Vec<String>,
}

impl Run {
    /// A run with the standard deviation of every sample.
    pub(super) fn with_band(run: FreeRun, variances: &[f64], is_measured: bool) -> Self {
        let FreeRun { simulated: y, start, fit_percent } = run;
        let end = |sign: f64| -> Vec<f64> {
            let half = |t: usize| if t < start { 0.0 } else { sign * Z95 * variances[t].max(0.0).sqrt() };
            y.iter().enumerate().map(|(t, y)| y + half(t)).collect()
        };
        let (low, high) = (end(-1.0), end(1.0));
        let fit_percent = (is_measured && start < y.len()).then_some(fit_percent);
        Self { low, high, y, start, fit_percent, notes: Vec::new() }
    }

    /// Share of the measured outputs after the start that lie within the band, where any was measured; the others are NaN.
    pub fn covered(&self, measured: &[f64]) -> Option<f64> {
        let judged: Vec<usize> = (self.start..self.y.len()).filter(|t| measured[*t].is_finite()).collect();
        let inside = |t: &&usize| (self.low[**t]..=self.high[**t]).contains(&measured[**t]);
        let count = judged.iter().filter(inside).count();
        (!judged.is_empty()).then(|| count as f64 / judged.len() as f64)
    }

    /// The fit figure on the outputs that were measured; the others are NaN.
    pub fn judged(self, measured: &[f64]) -> Self {
        let judged = (self.start..self.y.len()).filter(|t| measured[*t].is_finite());
        let (measured, simulated): (Vec<f64>, Vec<f64>) = judged.map(|t| (measured[t], self.y[t])).unzip();
        let fit_percent = (!measured.is_empty()).then(|| FreeRun::new(&measured, simulated, 0).fit_percent);
        Self { fit_percent, ..self }
    }
}
