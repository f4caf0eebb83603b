//! Intervals of nonlinear parameters whose likelihood has corners, from its profile.

use super::Task;
use crate::attribution::explain::{Hypothesis, assembled};
use crate::likelihood::engine::{Fit, FitContext};
use crate::records::dataset::Dataset;
use crate::workers::Workers;

/// Deviance over the least that a 90 % interval allows: quantile of χ² with one degree of freedom.
const WITHIN: f64 = 2.705_543;
/// The first distance tried, in steps of the parameter; halvings of it at most; bisections of the last octave.
const FIRST: f64 = 0.01;
const HALVINGS: usize = 12;
const BISECTIONS: usize = 3;
/// Gauss–Newton rounds of the rest at every point.
const ROUNDS: usize = 2;

/// The 90 % intervals of the nonlinear parameters. Without a standard error, it is where the deviance, the rest fitted anew and the other nonlinear
/// parameters held, stays within the quantile of χ² (D. J. Venzon and S. H. Moolgavkar, "A method for computing
/// profile-likelihood-based confidence intervals", 1988).
///
/// A likelihood with corners may be a staircase: values between which no sample decides are equally likely, and the interval need not
/// lie evenly about the estimate.
pub(crate) fn profiled(workers: &impl Workers, dataset: &Dataset, hypothesis: &Hypothesis) -> Vec<[f64; 2]> {
    let fit = &hypothesis.fit;
    let mut intervals = fit.intervals();
    let unknown: Vec<usize> = (0..intervals.len()).filter(|j| fit.nonlinear_se[*j].is_nan()).collect();
    let ends: Vec<(usize, f64)> = unknown.iter().flat_map(|&j| [(j, -1.0), (j, 1.0)]).collect();
    let design = fit.design();
    let found = workers.map(&ends, |&(j, side)| {
        let build = |values: &[f64]| assembled(&hypothesis.effect_terms, values);
        let context = FitContext { dataset, grid: &fit.grid, known: Some(&design) };
        Task { context, build: &build, fixed: 0 }.end(fit, j, side)
    });
    for (j, ends) in unknown.iter().zip(found.chunks(2)) {
        intervals[*j] = [ends[0], ends[1]];
    }
    intervals
}

impl Task<'_> {
    /// Where a nonlinear parameter that moves to one side leaves the interval, or its range ends.
    fn end(&self, fit: &Fit, j: usize, side: f64) -> f64 {
        let o = fit.nonlinear[j];
        let most = if side > 0.0 { o.high - o.value } else { o.value - o.low };
        let is_within = |distance: f64| {
            let mut nonlinear = fit.nonlinear.clone();
            nonlinear[j].value += side * distance;
            let there = self.fixed(&nonlinear, &fit.linear, ROUNDS);
            there.is_some_and(|there| there.deviance - fit.deviance < WITHIN)
        };
        o.value + side * crossing(FIRST * o.step, most, is_within)
    }
}

/// The distance, `most` at most, from which a condition that holds nearby holds no more; too large rather than too small.
fn crossing(first: f64, most: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut inside, mut outside) = (0.0, first.min(most));
    while holds(outside) {
        if outside >= most {
            return most;
        }
        (inside, outside) = (outside, (2.0 * outside).min(most));
    }
    for _ in 0..HALVINGS {
        if inside > 0.0 {
            break;
        }
        let half = 0.5 * outside;
        *(if holds(half) { &mut inside } else { &mut outside }) = half;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (inside + outside);
        *(if holds(middle) { &mut inside } else { &mut outside }) = middle;
    }
    outside
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_crossing_is_found_within_an_eighth_and_never_too_near(log in -5.0..3.9_f64) {
            let at = 10f64.powf(log);
            let found = crossing(0.01, 1e4, |x| x < at);
            prop_assert!((at..1.126 * at).contains(&found), "{found} {at}");
        }
    }

    #[test]
    fn what_never_ceases_to_hold_ends_with_the_range() {
        assert_eq!(crossing(0.01, 0.3, |_| true), 0.3);
    }
}
