//! Counts of the ends of intervals, fine enough to give the share of intervals around a value that is known only afterwards.
//!
//! Bias-eliminated coverage is the share of the intervals that hold the mean estimate instead of the truth: whether they are as wide as the estimates
//! scatter, whatever the bias (T. P. Morris, I. R. White, M. J. Crowther, *Statistics in Medicine* 38 (2019), 2074–2102, Table 6). The mean is known when
//! all replicates are. Kept are counts of both ends, less the truth, in classes of 1/64 of a power of two: of ends near the mean, which is small beside
//! an interval, the classes are narrow. Counts add up exactly, in any order.

use std::collections::BTreeMap;
use switchback_identify::statistics::{Measured, normal_quantile_975};

/// Both ends of the 95 % intervals of one parameter.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct IntervalEnds {
    lower: Counts,
    upper: Counts,
}

/// Values by their class.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Counts(BTreeMap<i64, u32>);

/// Bits of a number below the first that tell its class.
const BITS: u32 = 6;

/// Bits of a number that do not.
const REST: u32 = 52 - BITS;

/// The class of a number: classes are in the order of numbers.
fn class(x: f64) -> i64 {
    let size = (x.abs().to_bits() >> REST) as i64;
    if x.is_sign_negative() { -size - 1 } else { size }
}

/// Where in its class a number stands, from 0 to 1.
fn place(x: f64) -> f64 {
    let rest = x.abs().to_bits() & ((1 << REST) - 1);
    let share = rest as f64 / (1_u64 << REST) as f64;
    if x.is_sign_negative() { 1.0 - share } else { share }
}

impl Counts {
    fn merge(&mut self, other: &Self) {
        other.0.iter().for_each(|(class, count)| *self.0.entry(*class).or_default() += count);
    }

    /// How many values are below `x`; those of its own class as if they stood evenly in it.
    fn below(&self, x: f64) -> f64 {
        let own = class(x);
        let before: u32 = self.0.range(..own).map(|(_, count)| count).sum();
        f64::from(before) + place(x) * f64::from(self.0.get(&own).copied().unwrap_or(0))
    }

    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend((self.0.len() as u32).to_le_bytes());
        for (class, count) in &self.0 {
            bytes.extend(class.to_le_bytes());
            bytes.extend(count.to_le_bytes());
        }
    }

    fn read(bytes: &mut &[u8]) -> Option<Self> {
        let mut taken = || {
            let (own, rest) = bytes.split_first_chunk()?;
            *bytes = rest;
            Some(u32::from_le_bytes(*own))
        };
        let mut counts = BTreeMap::new();
        for _ in 0..taken()? {
            let [low, high, count] = [taken()?, taken()?, taken()?];
            counts.insert((u64::from(high) << 32 | u64::from(low)) as i64, count);
        }
        Some(Self(counts))
    }
}

impl IntervalEnds {
    /// Adds the interval of an estimate; nothing where it has no standard error.
    pub(super) fn push(&mut self, error: f64, se: f64) {
        let half = normal_quantile_975() * se;
        if half.is_finite() && error.is_finite() {
            *self.lower.0.entry(class(error - half)).or_default() += 1;
            *self.upper.0.entry(class(error + half)).or_default() += 1;
        }
    }

    /// Adds those of other replicates.
    pub(super) fn merge(&mut self, other: &Self) {
        self.lower.merge(&other.lower);
        self.upper.merge(&other.upper);
    }

    /// The share of the intervals that hold a value; `None` of no intervals.
    pub(super) fn coverage(&self, of: f64) -> Option<Measured> {
        let count = f64::from(self.lower.0.values().sum::<u32>());
        let value = ((self.lower.below(of) - self.upper.below(of)) / count).clamp(0.0, 1.0);
        (count > 0.0 && of.is_finite())
            .then(|| Measured { value, mcse: (value * (1.0 - value) / count).sqrt() })
    }

    /// Appends all that is in it.
    pub(super) fn write(&self, bytes: &mut Vec<u8>) {
        self.lower.write(bytes);
        self.upper.write(bytes);
    }

    /// Takes what [`write`](Self::write) appended from the beginning of `bytes`; `None` where there is too little.
    pub(super) fn read(bytes: &mut &[u8]) -> Option<Self> {
        Some(Self { lower: Counts::read(bytes)?, upper: Counts::read(bytes)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use switchback_noise::{StreamId, white_samples};

    fn ends(intervals: &[(f64, f64)]) -> IntervalEnds {
        let mut ends = IntervalEnds::default();
        intervals.iter().for_each(|(error, se)| ends.push(*error, *se));
        ends
    }

    proptest! {
        #[test]
        fn classes_are_in_the_order_of_numbers_and_no_wider_than_a_sixty_fourth(x in -1e9..1e9_f64, y in -1e9..1e9_f64) {
            prop_assert!(x > y || class(x) <= class(y));
            prop_assert!(class(x) != class(y) || (x - y).abs() <= x.abs().max(y.abs()) / 64.0);
            prop_assert!((0.0..=1.0).contains(&place(x)));
        }

        #[test]
        fn pieces_add_up_and_bytes_read_back(replicate in 0..1000_u32, cut in 0..50_usize) {
            let w = white_samples(StreamId { seed: 9, experiment: 0, replicate }, 50);
            let intervals: Vec<(f64, f64)> = w.iter().map(|x| (*x, 1.0 + 0.1 * x)).collect();
            let mut sum = ends(&intervals[cut..]);
            sum.merge(&ends(&intervals[..cut]));
            prop_assert_eq!(&sum, &ends(&intervals));
            let mut bytes = Vec::new();
            sum.write(&mut bytes);
            prop_assert_eq!(IntervalEnds::read(&mut &bytes[..bytes.len() - 1]), None);
            bytes.push(3);
            let mut rest = bytes.as_slice();
            prop_assert_eq!(IntervalEnds::read(&mut rest), Some(sum));
            prop_assert_eq!(rest, &[3]);
        }
    }

    #[test]
    fn the_mean_is_covered_as_often_as_if_all_intervals_had_been_kept() {
        for (bias, spread) in [(0.0, 0.0), (0.02, 0.1), (0.7, 0.3), (-25.0, 0.1)] {
            let w = white_samples(StreamId { seed: 5, experiment: 1, replicate: 2 }, 4000);
            let intervals: Vec<(f64, f64)> =
                w.chunks(2).map(|w| (w[0] + bias, 0.9 * (1.0 + spread * w[1].tanh()))).collect();
            let mean = intervals.iter().map(|(error, _)| error).sum::<f64>() / intervals.len() as f64;
            let holds = |(error, se): &&(f64, f64)| (error - mean).abs() <= normal_quantile_975() * se;
            let exact = intervals.iter().filter(holds).count() as f64 / intervals.len() as f64;
            let found = ends(&intervals).coverage(mean).expect("intervals");
            // The classes are a 64th of the mean wide: of a bias of 25 deviations four tenths of one.
            let allowed = if bias == -25.0 { 0.02 } else { 0.0011 };
            assert!((found.value - exact).abs() <= allowed, "{bias}: {found:?} {exact}");
            assert!((found.mcse - (exact * (1.0 - exact) / 2000.0).sqrt()).abs() < 3e-4);
        }
        assert_eq!(ends(&[(1.0, f64::NAN)]).coverage(0.0), None);
    }
}
