//! How far chance alone moves a figure: the limits of every check.
//!
//! A check fails where nothing is wrong with probability [`FALSE_ALARM`] at most. Its figures share that evenly (Bonferroni's inequality, which
//! asks nothing of their dependence), so that each of `m` figures gets `FALSE_ALARM/(2m)` on either side.

use statrs::distribution::{Binomial, ChiSquared, ContinuousCDF, DiscreteCDF, Normal};

/// Probability that one check fails though nothing is wrong, at most.
pub(crate) const FALSE_ALARM: f64 = 1e-6;

/// Probability on each side of each of the figures of a check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tail(f64);

impl Tail {
    /// Of a check that has this many figures which chance moves.
    pub(super) fn of(figures: usize) -> Self {
        Self(FALSE_ALARM / (2 * figures) as f64)
    }

    /// Half width of the range of a standard normal.
    pub(super) fn normal(self) -> f64 {
        -Normal::standard().inverse_cdf(self.0)
    }

    /// The range of a normal with that mean and standard deviation.
    pub(super) fn about(self, mean: f64, sd: f64) -> (f64, f64) {
        let half = self.normal() * sd;
        (mean - half, mean + half)
    }

    /// The range of `χ²_ν/ν`, the ratio of a variance estimate with `ν` degrees of freedom to what it estimates.
    pub(super) fn variance_ratio(self, degrees: f64) -> (f64, f64) {
        let law = ChiSquared::new(degrees).expect("positive degrees of freedom");
        // The upper quantile by bisection: 1 − 1e-8 keeps too few digits of the tail.
        let (mut below, mut above) = (degrees, 2.0 * degrees + 200.0);
        while above - below > 1e-9 * above {
            let middle = (below + above) / 2.0;
            if law.sf(middle) > self.0 { below = middle } else { above = middle }
        }
        (law.inverse_cdf(self.0) / degrees, above / degrees)
    }

    /// The range of the share of successes in so many independent trials.
    pub(super) fn share(self, trials: u64, probability: f64) -> (f64, f64) {
        let law = Binomial::new(probability, trials).expect("a probability");
        let least = first(trials, |k| law.cdf(k) > self.0);
        let most = first(trials, |k| law.sf(k) <= self.0);
        (least as f64 / trials as f64, most as f64 / trials as f64)
    }
}

/// The first number up to `most` from which on a condition holds.
fn first(most: u64, holds: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (0, most);
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { high = middle } else { low = middle + 1 }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ranges_leave_out_what_they_say() {
        let tail = Tail::of(10);
        assert_eq!(tail, Tail(5e-8));
        let (low, high) = tail.variance_ratio(50.0);
        let law = ChiSquared::new(50.0).expect("degrees");
        assert!((law.cdf(50.0 * low) / 5e-8 - 1.0).abs() < 1e-6, "{low}");
        assert!((law.sf(50.0 * high) / 5e-8 - 1.0).abs() < 1e-6, "{high}");
        let (low, high) = tail.share(2000, 0.95);
        let law = Binomial::new(0.95, 2000).expect("a law");
        let (low, high) = ((low * 2000.0).round() as u64, (high * 2000.0).round() as u64);
        assert!(law.cdf(low - 1) <= 5e-8 && law.cdf(low) > 5e-8, "{low}");
        assert!(law.sf(high) <= 5e-8 && law.sf(high - 1) > 5e-8, "{high}");
        assert!((Normal::standard().sf(tail.normal()) / 5e-8 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn rare_events_may_be_missing_altogether() {
        let (low, high) = Tail::of(10).share(10_000_000, 1e-8);
        assert!(low == 0.0 && high > 1e-7, "{low} {high}");
    }
}
