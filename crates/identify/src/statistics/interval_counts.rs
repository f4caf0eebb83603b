//! Where the truth lies in the intervals that replicates report.

use super::lane_errors::LaneErrors;
use super::quantile::normal_quantile_975;
use switchback_noise::lanes::{LANES, Lane};

/// Upper ends of the classes of `|θ̂ − θ|`, in half widths of the 95 % interval that the replicate reports. What lies beyond the last is
/// a class of its own.
///
/// The truth is in the interval up to 1. Classes are narrow where a sound estimate has most of its replicates, and reach far enough to show
/// intervals that are somewhat too narrow from those that miss the truth altogether.
pub const CLASS_ENDS: [f64; 9] = [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0, 5.0];

/// How many classes there are on either side of the truth.
pub const CLASSES: usize = CLASS_ENDS.len() + 1;

/// How many replicates' estimates of one parameter lie how far below and above the truth, in half widths of their own intervals.
///
/// ```text
/// class of |θ̂ − θ| / (Φ⁻¹(0.975)·se)
/// ```
///
/// From these a zip plot is drawn: the intervals in the order of how far their centre misses the truth (I. R. White, "simsum",
/// Stata Journal 10 (2010); Morris, White and Crowther 2019, Figure 6, doi 10.1002/sim.8086). Counts add up exactly, whatever the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct IntervalCounts {
    /// Estimates less than the truth, a number a class.
    pub below: [u32; CLASSES],
    /// Estimates greater than the truth, or equal to it.
    pub above: [u32; CLASSES],
}

impl IntervalCounts {
    /// Adds one replicate: `error = θ̂ − θ`, and the standard error that it reports.
    pub fn push(&mut self, error: f64, se: f64) {
        let (square, variance) = (error * error, se * se);
        // What is no number is beyond every class.
        let within = class_ends(variance).iter().filter(|end| square <= **end).count();
        self.side(error)[CLASSES - 1 - within] += 1;
    }

    /// Adds the replicates in the chosen lanes to the counts, one a parameter, given the true values.
    pub fn add(counts: &mut [Self], truth: &[f64], errors: &LaneErrors<'_>, chosen: &[bool; LANES]) {
        for (k, (counts, truth)) in counts.iter_mut().zip(truth).enumerate() {
            let error = errors.own.values[k] - Lane::splat(*truth);
            let square = error * error;
            let mut within = Lane::ZERO;
            for end in CLASS_ENDS {
                within += square.at_most(errors.own.variances[k] * squared(end));
            }
            for l in (0..LANES).filter(|&l| chosen[l]) {
                counts.side(error.0[l])[CLASSES - 1 - within.0[l] as usize] += 1;
            }
        }
    }

    /// Adds the counts of other replicates, or of another parameter.
    pub fn merge(&mut self, other: &Self) {
        let sides = [(&mut self.below, &other.below), (&mut self.above, &other.above)];
        for (into, from) in sides.into_iter().flat_map(|(into, from)| into.iter_mut().zip(from)) {
            *into += from;
        }
    }

    fn side(&mut self, error: f64) -> &mut [u32; CLASSES] {
        if error < 0.0 { &mut self.below } else { &mut self.above }
    }
}

/// The square of so many half widths, in variances.
#[inline(always)]
fn squared(end: f64) -> f64 {
    let reach = end * normal_quantile_975();
    reach * reach
}

fn class_ends(variance: f64) -> [f64; CLASS_ENDS.len()] {
    CLASS_ENDS.map(|end| variance * squared(end))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::LaneEstimates;
    use proptest::prelude::*;

    /// Counted by definition.
    fn slow(errors: &[(f64, f64)]) -> IntervalCounts {
        let mut counts = IntervalCounts::default();
        for (error, se) in errors {
            let half_widths = error.abs() / (1.959_963_984_540_054 * se);
            let class = (0..CLASSES - 1).find(|k| half_widths <= CLASS_ENDS[*k]).unwrap_or(CLASSES - 1);
            if *error < 0.0 { counts.below[class] += 1 } else { counts.above[class] += 1 }
        }
        counts
    }

    proptest! {
        #[test]
        fn lanes_and_single_replicates_count_as_the_definition_does(
            errors in prop::collection::vec((-30.0..30.0_f64, 0.5..3.0_f64), LANES),
            chosen in prop::array::uniform8(any::<bool>()),
        ) {
            let truth = 0.75;
            let lane = |f: &dyn Fn(usize) -> f64| Lane(std::array::from_fn(f));
            let values = [lane(&|l| truth + errors[l].0)];
            let variances = [lane(&|l| errors[l].1 * errors[l].1)];
            let zero = [Lane::ZERO];
            let own = LaneEstimates { values: &values, variances: &variances, first_order: &zero, second_order: &zero };
            let lanes = LaneErrors { own, mirrored: None, first_variances: None };
            let mut counts = [IntervalCounts::default()];
            IntervalCounts::add(&mut counts, &[truth], &lanes, &chosen);
            let picked: Vec<_> = (0..LANES).filter(|&l| chosen[l]).map(|l| errors[l]).collect();
            prop_assert_eq!(counts[0], slow(&picked));
            let mut one_by_one = IntervalCounts::default();
            picked.iter().for_each(|(error, se)| one_by_one.push(*error, *se));
            prop_assert_eq!(counts[0], one_by_one);
        }

        #[test]
        fn the_order_of_parts_does_not_matter(errors in prop::collection::vec((-9.0..9.0_f64, 0.5..3.0_f64), 0..40), cut in 0..40_usize) {
            let (first, second) = errors.split_at(cut.min(errors.len()));
            let (mut one, mut two) = (slow(first), slow(second));
            let (before, after) = (one, two);
            one.merge(&after);
            two.merge(&before);
            prop_assert_eq!(one, two);
            prop_assert_eq!(one, slow(&errors));
        }
    }

    #[test]
    fn what_is_no_number_or_has_no_width_is_beyond_every_class_unless_it_is_right() {
        let mut counts = IntervalCounts::default();
        counts.push(f64::NAN, 1.0);
        counts.push(-0.5, 0.0);
        counts.push(0.0, 0.0);
        assert_eq!((counts.above[CLASSES - 1], counts.below[CLASSES - 1], counts.above[0]), (1, 1, 1));
    }
}
