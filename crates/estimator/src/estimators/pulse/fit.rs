//! What the pulse methods return, and how it is drawn from a solved regression.

use super::arrow::{ArrowFit, Gradient, NotExcited, Response};
use super::data::{PulseData, StepMean};
use super::experiments::Experiments;
use crate::estimators::{BorderPoint, Estimate};
use crate::hysteresis::Branch;
use nalgebra::DVector;
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

/// How the absolute level of the borders was found.
pub(crate) enum Level<'a> {
    /// From the constant column `κ`, the last core parameter; levels are relative to `u_m`.
    Constant,
    /// From a step experiment; levels are relative to the satellite's. The response is that of the regression to a constant.
    Step { step: StepMean, response: &'a Response },
}

/// A level's value relative to the base, and its derivative.
pub(crate) struct RelativeLevel {
    pub(crate) value: f64,
    pub(crate) gradient: Gradient,
}

/// Rank-one value `Σᵢ bᵢhᵢ / Σᵢ bᵢ²` (3.24b) of a level whose free means `hᵢ ≈ bᵢ f` are local columns `first…first+n−1`.
pub(crate) fn rank_one_level(fit: &ArrowFit, order: usize, first_local: usize) -> RelativeLevel {
    let b = fit.core.rows(order, order);
    let h = &fit.local[first_local..first_local + order];
    let norm: f64 = b.iter().map(|x| x * x).sum();
    let inner: f64 = b.iter().zip(h).map(|(b, h)| b * h).sum();
    let mut core = DVector::zeros(fit.core.len());
    for i in 0..order {
        core[order + i] = h[i] / norm - 2.0 * b[i] * inner / (norm * norm);
    }
    let local = (0..order).map(|i| (first_local + i, b[i] / norm)).collect();
    RelativeLevel { value: inner / norm, gradient: Gradient { core, local } }
}

/// A level that the method does not estimate.
pub(crate) fn known_level(fit: &ArrowFit, value: f64) -> RelativeLevel {
    RelativeLevel { value, gradient: Gradient { core: DVector::zeros(fit.core.len()), local: Vec::new() } }
}

/// The base of the levels: `u` where the relative level is zero, with its derivatives.
struct Base {
    value: f64,
    core: DVector<f64>,
    /// Derivative in `ŷ₀`, where there is a step experiment.
    step: f64,
}

/// Turns a solved regression with core `(a, b[, κ])` and its relative levels into a [`PulseFit`].
///
/// ```text
/// constant column:  F(V_j) = w_j + κ/B(1),            κ about the reference r: κ = κ' + A(1)·r
/// step experiment:  F(V_j) = f_j + A(1)/B(1)·ŷ₀       (3.25)
/// ```
///
/// Standard errors follow by the delta method; with a step experiment the error of `ŷ₀` (variance `σ²/(A(1)²L)`) enters both directly
/// and through the regression on `ỹ = y − ŷ₀`, whose residual it leaves at `−A(1)·δ`.
pub(crate) fn finish(
    experiments: &Experiments<'_>,
    fit: &ArrowFit,
    levels: Vec<Vec<RelativeLevel>>,
    level: Level<'_>,
) -> Result<PulseFit, PulseFitError> {
    let n = experiments.order();
    let a_at_one = 1.0 + fit.core.rows(0, n).sum();
    let b_at_one: f64 = fit.core.rows(n, n).sum();
    if b_at_one == 0.0 || !b_at_one.is_finite() {
        return Err(PulseFitError::NoGain);
    }
    let base = base_level(fit, n, experiments.reference, &level);
    let se = |gradient: &Gradient, direct: f64| {
        let through_step = match &level {
            Level::Constant => 0.0,
            Level::Step { step, response } => {
                let slope = direct - a_at_one * response.along(gradient);
                slope * slope * fit.variance / (a_at_one * a_at_one * step.samples)
            }
        };
        (fit.variance_of(gradient) + through_step).sqrt()
    };
    let coefficient = |k: usize| {
        let mut core = DVector::zeros(fit.core.len());
        core[k] = 1.0;
        Estimated { value: fit.core[k], se: se(&Gradient { core, local: Vec::new() }, 0.0) }
    };
    let borders = levels
        .into_iter()
        .map(|of_experiment| {
            of_experiment
                .into_iter()
                .map(|mut relative| {
                    relative.gradient.core += &base.core;
                    Estimated { value: base.value + relative.value, se: se(&relative.gradient, base.step) }
                })
                .collect()
        })
        .collect();
    let u_low = match (&level, experiments.parts[0].branch) {
        (Level::Step { .. }, Branch::Descending) => base.value - 1.0,
        _ => base.value,
    };
    Ok(PulseFit {
        a: (0..n).map(coefficient).collect(),
        b: (n..2 * n).map(coefficient).collect(),
        borders,
        noise_sd: fit.variance.sqrt(),
        u_low,
    })
}

fn base_level(fit: &ArrowFit, n: usize, reference: f64, level: &Level<'_>) -> Base {
    let a_at_one = 1.0 + fit.core.rows(0, n).sum();
    let b_at_one: f64 = fit.core.rows(n, n).sum();
    let mut core = DVector::zeros(fit.core.len());
    let (held, output) = match level {
        Level::Constant => {
            core[2 * n] = 1.0 / b_at_one;
            (fit.core[2 * n] + a_at_one * reference, reference)
        }
        Level::Step { step, .. } => (a_at_one * step.mean, step.mean),
    };
    for i in 0..n {
        core[i] = output / b_at_one;
        core[n + i] = -held / (b_at_one * b_at_one);
    }
    Base { value: held / b_at_one, core, step: a_at_one / b_at_one }
}

impl PulseFit {
    /// `B̂(1)/Â(1)`, output units per normalised `u`.
    pub fn gain(&self) -> f64 {
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
