//! Adding eight replicates at a time to the running sums.

use super::error_sums::{ErrorSums, normal_quantile_975};
use crate::lanes::{LANES, Lane, Work, keep_apart, widest};
use std::ops::Range;

/// What eight replicates tell of every parameter of a cell: [`ReplicateError`](super::ReplicateError) in lanes.
#[derive(Debug, Clone, Copy)]
pub struct LaneErrors<'a> {
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
#[derive(Debug, Clone, PartialEq, Default)]
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

    /// Makes room for so many parameters, in the memory at hand. What was not drained from those there were before is lost.
    pub fn reset(&mut self, parameters: usize) {
        if self.count > 0 {
            *self = Self::default();
        }
        self.terms.resize(parameters, [Lane::ZERO; TERMS]);
    }

    /// Adds the replicates in some of the lanes, given the true values.
    pub fn add(&mut self, truth: &[f64], errors: LaneErrors<'_>, lanes: Range<usize>) {
        self.count += lanes.len();
        let chosen: [bool; LANES] = std::array::from_fn(|l| lanes.contains(&l));
        widest(Add { truth, errors: &[errors], sums: &mut self.terms, chosen: Some(&chosen) });
    }

    /// Adds the replicates in all lanes, one [`LaneErrors`] after the other: the same to the bit as [`Self::add`] for each, in less time.
    pub fn add_all(&mut self, truth: &[f64], errors: &[LaneErrors<'_>]) {
        self.count += errors.len() * LANES;
        widest(Add { truth, errors, sums: &mut self.terms, chosen: None });
    }

    /// Hands everything over to the sums of each parameter, and begins anew.
    pub fn drain_into(&mut self, sums: &mut [ErrorSums]) {
        if self.count > 0 {
            widest(Drain { count: self.count as f64, running: &mut self.terms, sums });
            self.count = 0;
        }
    }
}

/// [`LaneSums::drain_into`] on its way.
struct Drain<'a> {
    count: f64,
    running: &'a mut [[Lane; TERMS]],
    sums: &'a mut [ErrorSums],
}

impl Work for Drain<'_> {
    #[inline(always)]
    fn run(self) {
        for (terms, sums) in self.running.iter_mut().zip(self.sums) {
            let mut totals = [0.0; TERMS];
            for k in 0..TERMS {
                totals[k] = terms[k].total();
            }
            sums.add(self.count, totals);
            *terms = [Lane::ZERO; TERMS];
        }
    }
}

/// [`LaneSums::add`] on its way.
struct Add<'a> {
    truth: &'a [f64],
    errors: &'a [LaneErrors<'a>],
    sums: &'a mut [[Lane; TERMS]],
    /// The lanes that are added; all of them if it is not said.
    chosen: Option<&'a [bool; LANES]>,
}

impl Work for Add<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { truth, errors, sums, chosen } = self;
        let quantile = normal_quantile_975();
        let covered = quantile * quantile;
        for (k, (truth, sums)) in truth.iter().zip(sums).enumerate() {
            keep_apart();
            let mut running = *sums;
            for errors in errors {
                keep_apart();
                let terms = errors.terms(k, *truth, covered);
                match chosen {
                    None => {
                        for k in 0..TERMS {
                            running[k] += terms[k];
                        }
                    }
                    // A lane that is left out may hold anything, so it is not multiplied by zero.
                    Some(chosen) => {
                        for k in 0..TERMS {
                            running[k] += terms[k].where_or(chosen, Lane::ZERO);
                        }
                    }
                }
            }
            *sums = running;
        }
    }
}

impl LaneErrors<'_> {
    /// The terms of parameter `k`; `covered` is the largest squared error over variance that an interval covers.
    #[inline(always)]
    fn terms(&self, k: usize, truth: f64, covered: f64) -> [Lane; TERMS] {
        let (variance, first) = (self.variances[k], self.first_order[k]);
        let error = self.values[k] - Lane::splat(truth);
        let square = error * error;
        let beyond_first = error - first;
        let remainder = beyond_first - self.second_order[k];
        let square_remainder = beyond_first * (error + first);
        [
            error,
            square,
            square * error,
            square * square,
            variance,
            variance * variance,
            square.at_most(variance * covered),
            remainder,
            remainder * remainder,
            square_remainder,
            square_remainder * square_remainder,
        ]
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
                values: &[left_out(values)],
                variances: &[left_out(variances)],
                first_order: &[left_out(first)],
                second_order: &[left_out(second)],
            };
            let (mut fast, mut running) = ([ErrorSums::default()], LaneSums::new(1));
            running.add(&[0.3], errors, lanes.clone());
            running.add(&[0.3], errors, lanes.clone());
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

        #[test]
        fn all_at_once_adds_the_bits_of_one_after_the_other(
            numbers in prop::collection::vec(prop::array::uniform8(0.01..1.0_f64), 2 * 3 * 4), truth in prop::array::uniform2(-1.0..1.0_f64),
        ) {
            let lanes: Vec<Lane> = numbers.into_iter().map(Lane).collect();
            let errors: Vec<LaneErrors<'_>> = lanes
                .chunks_exact(8)
                .map(|x| LaneErrors { values: &x[..2], variances: &x[2..4], first_order: &x[4..6], second_order: &x[6..] })
                .collect();
            let (mut together, mut apart) = (LaneSums::new(2), LaneSums::default());
            apart.reset(2);
            together.add_all(&truth, &errors);
            errors.iter().for_each(|errors| apart.add(&truth, *errors, 0..LANES));
            prop_assert_eq!(&together, &apart);
            let mut drained = [ErrorSums::default(); 2];
            together.drain_into(&mut drained);
            prop_assert_eq!(drained.map(|sums| sums.count()), [3 * LANES; 2]);
            prop_assert_eq!(together, LaneSums::new(2));
        }
    }
}
