//! Adding eight replicates at a time to the running sums.

use super::error_sums::{ErrorSums, normal_quantile_975};
use crate::lanes::{LANES, Lane, Work, keep_apart, widest};
use std::ops::Range;

/// What eight replicates tell of every parameter of a cell: [`ReplicateError`](super::ReplicateError) in lanes.
#[derive(Debug, Clone, Copy)]
pub struct LaneErrors<'a> {
    /// The true values.
    pub truth: &'a [f64],
    /// The estimates `θ̂`.
    pub values: &'a [Lane],
    /// Variances that the method reports.
    pub variances: &'a [Lane],
    /// First-order part of the errors.
    pub first_order: &'a [Lane],
    /// What is known of the second.
    pub second_order: &'a [Lane],
}

/// Sums of a replicate's terms: error and its powers, variance and its square, coverage, remainder and its square, remainder of the
/// square and its square.
pub(super) const TERMS: usize = 11;

/// The running sums of a cell's parameters, lane by lane, on their way to [`ErrorSums`].
#[derive(Debug, Clone, PartialEq)]
pub struct LaneSums {
    /// Replicates so far.
    count: usize,
    terms: Vec<[Lane; TERMS]>,
}

impl LaneSums {
    /// Nothing yet, of so many parameters.
    pub fn new(parameters: usize) -> Self {
        Self { count: 0, terms: vec![[Lane::ZERO; TERMS]; parameters] }
    }

    /// Adds the replicates in some of the lanes.
    pub fn add(&mut self, errors: LaneErrors<'_>, lanes: Range<usize>) {
        self.count += lanes.len();
        widest(Add { errors, sums: &mut self.terms, lanes });
    }

    /// Hands everything over to the sums of each parameter, and begins anew.
    pub fn drain_into(&mut self, sums: &mut [ErrorSums]) {
        if self.count > 0 {
            for (terms, sums) in self.terms.iter_mut().zip(sums) {
                sums.add(self.count as f64, terms.map(Lane::total));
                *terms = [Lane::ZERO; TERMS];
            }
            self.count = 0;
        }
    }
}

/// [`LaneSums::add`] on its way.
struct Add<'a> {
    errors: LaneErrors<'a>,
    sums: &'a mut [[Lane; TERMS]],
    lanes: Range<usize>,
}

impl Work for Add<'_> {
    #[inline(always)]
    fn run(self) {
        let LaneErrors { truth, values, variances, first_order, second_order } = self.errors;
        let quantile = normal_quantile_975();
        let chosen: [bool; LANES] = std::array::from_fn(|l| self.lanes.contains(&l));
        let all = self.lanes.len() == LANES;
        let orders = first_order.iter().zip(second_order);
        let replicates = values.iter().zip(variances).zip(orders).zip(truth);
        for ((((value, variance), (first, second)), truth), sums) in replicates.zip(self.sums) {
            keep_apart();
            // A lane that is left out may hold anything, so it is not multiplied by zero.
            let mut add = |k: usize, term: Lane| {
                sums[k] += if all { term } else { term.where_or(&chosen, Lane::ZERO) };
            };
            let error = *value - Lane::splat(*truth);
            let square = error * error;
            add(0, error);
            add(1, square);
            add(2, square * error);
            add(3, square * square);
            add(4, *variance);
            add(5, *variance * *variance);
            add(6, square.at_most(*variance * (quantile * quantile)));
            keep_apart();
            let beyond_first = error - *first;
            let remainder = beyond_first - *second;
            add(7, remainder);
            add(8, remainder * remainder);
            keep_apart();
            let square_remainder = beyond_first * (error + *first);
            add(9, square_remainder);
            add(10, square_remainder * square_remainder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::ReplicateError;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lanes_add_what_their_replicates_add_one_by_one(
            values in prop::array::uniform8(-1.0..1.0_f64), variances in prop::array::uniform8(0.0..0.5_f64), first in prop::array::uniform8(-1.0..1.0_f64),
            second in prop::array::uniform8(-0.1..0.1_f64),
            start in 0..LANES, count in 0..=LANES,
        ) {
            let lanes = start..LANES.min(start + count);
            let left_out = |x: [f64; LANES]| Lane(std::array::from_fn(|l| if lanes.contains(&l) { x[l] } else { f64::NAN }));
            let errors = LaneErrors {
                truth: &[0.3],
                values: &[left_out(values)],
                variances: &[left_out(variances)],
                first_order: &[left_out(first)],
                second_order: &[left_out(second)],
            };
            let (mut fast, mut running) = ([ErrorSums::default()], LaneSums::new(1));
            running.add(errors, lanes.clone());
            running.add(errors, lanes.clone());
            running.drain_into(&mut fast);
            running.drain_into(&mut fast);
            let mut slow = ErrorSums::default();
            for l in lanes.clone().chain(lanes) {
                slow.push(ReplicateError {
                    error: values[l] - 0.3,
                    se: variances[l].sqrt(),
                    first_order: Some(first[l]),
                    second_order: second[l],
                });
            }
            let all = |sums: &ErrorSums| sums.performance(Some(0.1)).map(|p| {
                let controlled = [p.bias_controlled, p.sd_controlled].map(|x| x.map_or(0.0, |x| x.value + x.mcse));
                [p.bias.value, p.bias.mcse, p.mse.value, p.mse.mcse, p.coverage.value, p.model_sd.value, p.model_sd.mcse, controlled[0], controlled[1]]
            });
            prop_assert_eq!(fast[0].count(), slow.count());
            for (fast, slow) in all(&fast[0]).iter().flatten().zip(all(&slow).iter().flatten()) {
                prop_assert!((fast - slow).abs() < 1e-7, "{} against {}", fast, slow);
            }
        }
    }
}
