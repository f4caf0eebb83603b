//! Adding eight replicates at a time to the running sums.

use super::error_sums::{ErrorSums, normal_quantile_975};
use crate::lanes::{Lane, Work, widest};
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
    /// Adds the replicates in some of the lanes, in order, to the sums of each parameter.
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
        let replicates = values.iter().zip(variances).zip(first_order).zip(truth);
        for ((((value, variance), first), truth), sums) in replicates.zip(self.sums) {
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
            sums.add(&terms, self.lanes.clone());
        }
    }
}
