//! One mark for several cells that differ in what a figure does not distinguish.

use super::axis::Axis;
use switchback_study::results::{Measured, Paired};

/// Standard errors to either side of a figure that bars show: about 95 %.
pub(super) const ERRORS: f64 = 2.0;

/// Share of an axis that a mark beside its place takes.
const BESIDE: f64 = 0.012;

/// An axis over `N` with room at its ends for so many marks beside each other.
pub(super) fn samples_axis(samples: impl IntoIterator<Item = usize>, marks: usize) -> Axis {
    Axis::logarithmic(samples.into_iter().map(|n| n as f64)).widened(BESIDE * marks as f64)
}

/// The median of some figures, and how far the lowest and the highest of their intervals reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    /// The median.
    pub(super) middle: f64,
    /// Lower and upper end.
    pub(super) ends: (f64, f64),
}

impl Spread {
    /// Of figures with their intervals; `None` of nothing.
    pub(super) fn of(figures: impl IntoIterator<Item = (f64, (f64, f64))>) -> Option<Self> {
        let mut middles = Vec::new();
        let mut ends = (f64::INFINITY, f64::NEG_INFINITY);
        for (value, (low, high)) in figures {
            middles.push(value);
            ends = (ends.0.min(low), ends.1.max(high));
        }
        middles.sort_by(f64::total_cmp);
        let half = middles.len() / 2;
        let middle = match middles.len() {
            0 => return None,
            n if n % 2 == 1 => middles[half],
            _ => (middles[half - 1] + middles[half]) / 2.0,
        };
        Some(Self { middle, ends })
    }

    /// Of figures with their Monte-Carlo errors.
    pub(super) fn of_measured(figures: impl IntoIterator<Item = Measured>) -> Option<Self> {
        Self::of(figures.into_iter().map(|m| {
            let reach = ERRORS * m.mcse();
            (m.value(), (m.value() - reach, m.value() + reach))
        }))
    }

    /// Of ratios on the same noise.
    pub(super) fn of_ratios(figures: impl IntoIterator<Item = Paired>) -> Option<Self> {
        Self::of(figures.into_iter().map(|p| (p.value(), p.interval(ERRORS))))
    }

    /// The ends where a logarithmic axis has a place for them: what reaches zero goes on beyond any frame.
    pub(super) fn positive_ends(self) -> (f64, f64) {
        (if self.ends.0 > 0.0 { self.ends.0 } else { f64::MIN_POSITIVE }, self.ends.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_and_the_outermost_ends() {
        let m = |value, mcse| Measured::new(value, mcse).expect("finite");
        assert_eq!(Spread::of_measured([]), None);
        let one = Spread::of_measured([m(2.0, 0.5)]).expect("a figure");
        assert_eq!((one.middle, one.ends), (2.0, (1.0, 3.0)));
        let three = Spread::of_measured([m(9.0, 0.5), m(2.0, 2.0), m(4.0, 0.1)]).expect("figures");
        assert_eq!((three.middle, three.ends), (4.0, (-2.0, 10.0)));
        assert_eq!(three.positive_ends(), (f64::MIN_POSITIVE, 10.0));
        assert_eq!(Spread::of_measured([m(1.0, 0.0), m(3.0, 0.0)]).map(|s| s.middle), Some(2.0));
    }
}
