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
}

impl LaneErrors<'_> {
    /// Adds the replicates in some of the lanes to the sums of each parameter.
    pub fn add_to(self, sums: &mut [ErrorSums], lanes: Range<usize>) {
        widest(Add { errors: self, sums, lanes });
    }
}

struct Add<'a> {
    errors: LaneErrors<'a>,
    sums: &'a mut [ErrorSums],
    lanes: Range<usize>,
}

impl Work for Add<'_> {
    #[inline(always)]
    fn run(self) {
        let LaneErrors { truth, values, variances, first_order } = self.errors;
        let quantile = normal_quantile_975();
        let count = self.lanes.len() as f64;
        let chosen: [bool; LANES] = std::array::from_fn(|l| self.lanes.contains(&l));
        let replicates = values.iter().zip(variances).zip(first_order).zip(truth);
        for ((((value, variance), first), truth), sums) in replicates.zip(self.sums) {
            keep_apart();
            let error = *value - Lane::splat(*truth);
            let square = error * error;
            let (cube, fourth) = (square * error, square * square);
            let remainder = error - *first;
            let square_remainder = remainder * (error + *first);
            let covered = square.at_most(*variance * (quantile * quantile));
            let terms = [
                error,
                square,
                cube,
                fourth,
                *variance,
                *variance * *variance,
                covered,
                remainder,
                remainder * remainder,
                square_remainder,
                square_remainder * square_remainder,
            ];
            // A lane that is left out may hold anything, so it is not multiplied by zero.
            let totals = match self.lanes.len() {
                LANES => terms.map(Lane::total),
                _ => terms.map(|term| term.where_or(&chosen, Lane::ZERO).total()),
            };
            sums.add(count, totals);
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
            start in 0..LANES, count in 0..=LANES,
        ) {
            let lanes = start..LANES.min(start + count);
            let left_out = |x: [f64; LANES]| Lane(std::array::from_fn(|l| if lanes.contains(&l) { x[l] } else { f64::NAN }));
            let errors = LaneErrors {
                truth: &[0.3],
                values: &[left_out(values)],
                variances: &[left_out(variances)],
                first_order: &[left_out(first)],
            };
            let mut fast = [ErrorSums::default()];
            errors.add_to(&mut fast, lanes.clone());
            errors.add_to(&mut fast, lanes.clone());
            let mut slow = ErrorSums::default();
            for l in lanes.clone().chain(lanes) {
                slow.push(ReplicateError { error: values[l] - 0.3, se: variances[l].sqrt(), first_order: Some(first[l]) });
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
