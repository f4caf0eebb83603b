//! What the pulse methods return, and why there may be nothing to return.

use super::arrow::NotExcited;
use super::data::PulseData;
use crate::{BorderPoint, Estimate, LevelErrors};
use switchback_model::hysteresis::Branch;
use thiserror::Error;

/// A number with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// The estimate.
    pub value: f64,
    /// Its standard error (delta method, white equation error).
    pub se: f64,
}

/// An estimate from pulse experiments, in the normalisation `u_M − u_m = 1`.
#[derive(Debug, Clone, PartialEq)]
pub struct PulseFit {
    /// `a₁…aₙ`.
    pub a: Vec<Estimated>,
    /// `b₁…bₙ`, output units per normalised `u`.
    pub b: Vec<Estimated>,
    /// `F̂(V_j)`, `j = 1…m`, one list an experiment, in the order of the experiments given.
    pub borders: Vec<Vec<Estimated>>,
    /// Standard deviation of the equation error.
    pub noise_sd: f64,
    /// `F̂` at `(h_m, u_m)`.
    pub u_low: f64,
    /// Standard errors of the gain and of the stationary outputs at both ends.
    pub level_errors: LevelErrors,
}

/// Why a method has no estimate to give.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PulseFitError {
    /// The information matrix is singular.
    #[error(
        "the record does not excite every parameter (the information matrix is singular); lower the order, or record more periods"
    )]
    NotExcited,
    /// Visits that do not repeat have no folds.
    #[error(
        "the visits do not repeat with one period, or not twice in whole, and the method `instrumental` averages over periods; play the experiment that `switchback design` writes, or use the method `efficient`"
    )]
    NotPeriodic,
    /// `B̂` or `B̂(1)` vanishes, so levels cannot be restored.
    #[error(
        "the estimated static gain is zero, so the borders' level cannot be found; check the input and the output"
    )]
    NoGain,
}

impl From<NotExcited> for PulseFitError {
    fn from(_: NotExcited) -> Self {
        Self::NotExcited
    }
}

impl PulseFit {
    /// `a`, `b`, then the points of each border: every estimated number in one fixed order.
    pub fn parameters(&self) -> impl Iterator<Item = &Estimated> {
        self.a.iter().chain(&self.b).chain(self.borders.iter().flatten())
    }

    /// `B̂(1)/Â(1)`, output units per normalised `u`.
    pub(crate) fn gain(&self) -> f64 {
        let a: f64 = self.a.iter().map(|x| x.value).sum();
        self.b.iter().map(|x| x.value).sum::<f64>() / (1.0 + a)
    }

    /// The estimate in full, for the experiments it was made from (in the same order).
    ///
    /// The end of each border that the normalisation fixes is included: `F(h_M) = u_M` on the ascending border,
    /// `F(h_m) = u_m` on the descending one, where the experiments show them.
    pub fn estimate(&self, experiments: &[&PulseData]) -> Estimate {
        let mut estimate = Estimate {
            a: self.a.iter().map(|x| x.value).collect(),
            a_se: self.a.iter().map(|x| x.se).collect(),
            b: self.b.iter().map(|x| x.value).collect(),
            b_se: self.b.iter().map(|x| x.se).collect(),
            delay: 0,
            noise_sd: self.noise_sd,
            gain: self.gain(),
            y_high: self.gain() * (self.u_low + 1.0),
            y_low: self.gain() * self.u_low,
            descending: Vec::new(),
            ascending: Vec::new(),
            excitation: super::excitation(experiments),
            samples: experiments.iter().map(|e| e.statistics.samples() as usize).sum(),
        };
        for (data, points) in experiments.iter().zip(&self.borders) {
            let border = match data.branch {
                Branch::Descending => &mut estimate.descending,
                Branch::Ascending => &mut estimate.ascending,
            };
            border.extend(data.levels.iter().zip(points).map(|(&v, p)| BorderPoint {
                v,
                f: p.value,
                se: p.se,
            }));
            border.sort_by(|p, q| p.v.total_cmp(&q.v));
        }
        estimate
    }
}
