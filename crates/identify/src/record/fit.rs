//! Levenberg–Marquardt over the free quantities of a system.

use super::criterion::Criterion;
use super::sensitivities::Sensitivities;
use super::stretch::Stretch;
use nalgebra::{DMatrix, DVector};
use switchback_model::system::{Quantity, Scale, System};

/// How hard a fit tries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Most iterations.
    pub iterations: usize,
    /// Relative decrease of the deviance below which a step is the last.
    pub tolerance: f64,
}

impl Effort {
    /// To rank candidates.
    pub const SEARCH: Self = Self { iterations: 6, tolerance: 1e-3 };
    /// To report.
    pub const FINAL: Self = Self { iterations: 40, tolerance: 1e-14 };
}

/// The system of least deviance near a start, the given quantities free and all others fixed; with that deviance.
///
/// D. Marquardt, SIAM J. Appl. Math. 11 (1963), doi 10.1137/0111030.
pub fn fit(
    start: &System,
    quantities: &[Quantity],
    stretches: &[Stretch],
    (criterion, scale): (&Criterion, &Scale),
    effort: Effort,
) -> (System, f64) {
    let mut system = start.clone();
    let mut now = Sensitivities::deviance(&system, stretches, criterion);
    let mut damping = 1e-4;
    for _ in 0..effort.iterations {
        let local = Sensitivities::of(&system, quantities, stretches, (criterion, scale));
        let before = now;
        while damping < 1e9 {
            let Some(step) = step(&local.information, &local.gradient, damping) else {
                damping *= 10.0;
                continue;
            };
            let next = moved(&system, quantities, &step);
            let deviance = if next.is_sound(scale) {
                Sensitivities::deviance(&next, stretches, criterion)
            } else {
                f64::INFINITY
            };
            if deviance < now {
                (system, now) = (next, deviance);
                damping = (damping * 0.2).max(1e-9);
                break;
            }
            damping *= 6.0;
        }
        if before - now <= effort.tolerance * before {
            break;
        }
    }
    (system, now)
}

pub(super) fn moved(system: &System, quantities: &[Quantity], step: &DVector<f64>) -> System {
    // Values are read before any is set: a set of one may change another.
    let values: Vec<f64> = quantities.iter().map(|q| q.value(system)).collect();
    let pairs = quantities.iter().zip(values).zip(step.iter());
    pairs.fold(system.clone(), |system, ((quantity, value), step)| quantity.set(&system, value + step))
}

/// `(H + λ diag H)⁻¹g`; none where rounding leaves `H` indefinite.
fn step(information: &DMatrix<f64>, gradient: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let count = gradient.len();
    let scale = DVector::from_fn(count, |i, _| information[(i, i)].sqrt().max(f64::MIN_POSITIVE));
    let mut scaled = DMatrix::from_fn(count, count, |i, j| information[(i, j)] / (scale[i] * scale[j]));
    for i in 0..count {
        scaled[(i, i)] += damping + 1e-12;
    }
    let solved = scaled.cholesky()?.solve(&gradient.component_div(&scale)).component_div(&scale);
    solved.iter().all(|x| x.is_finite()).then_some(solved)
}
