//! Shares with their intervals.

use serde::{Deserialize, Serialize};

/// A share of counted rigs. A file shows its value, too.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(from = "ShareFile", into = "ShareFile")]
pub struct Share {
    /// Rigs for which it holds.
    pub count: usize,
    /// Rigs counted.
    pub of: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ShareFile {
    count: usize,
    of: usize,
    share: Option<f64>,
}

impl From<Share> for ShareFile {
    fn from(share: Share) -> Self {
        Self { count: share.count, of: share.of, share: share.value() }
    }
}

impl From<ShareFile> for Share {
    fn from(ShareFile { count, of, .. }: ShareFile) -> Self {
        Self { count, of }
    }
}

impl Share {
    /// Counts over some cases.
    pub(crate) fn over<'a, C: 'a>(cases: impl Iterator<Item = &'a C>, holds: impl Fn(&C) -> bool) -> Self {
        cases.fold(Self::default(), |s, c| Self { count: s.count + usize::from(holds(c)), of: s.of + 1 })
    }

    /// The share; none of nothing.
    pub fn value(self) -> Option<f64> {
        (self.of > 0).then(|| self.count as f64 / self.of as f64)
    }

    /// Its 95 % interval (Wilson, J. Am. Stat. Assoc. 22, 1927): what other rigs drawn alike may say.
    pub fn interval(self) -> Option<[f64; 2]> {
        const Z: f64 = 1.96;
        let (p, n) = (self.value()?, self.of as f64);
        let centre = p + Z * Z / (2.0 * n);
        let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        Some([((centre - half) / scale).max(0.0), ((centre + half) / scale).min(1.0)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_solves_the_score_equation_and_none_of_many_is_not_none() {
        for (count, of) in [(0, 22), (5, 25), (16, 17), (300, 300)] {
            let share = Share { count, of };
            let p = share.value().unwrap();
            let [low, high] = share.interval().unwrap();
            for end in [low, high].into_iter().filter(|x| *x > 1e-9 && *x < 1.0 - 1e-9) {
                // The ends are where the observed share is 1.96 standard errors of the end away.
                let errors = (p - end).abs() / (end * (1.0 - end) / of as f64).sqrt();
                assert!((errors - 1.96).abs() < 1e-9, "{count} of {of}: {errors}");
            }
        }
        let high = Share { count: 0, of: 22 }.interval().unwrap()[1];
        assert!((high - 1.96 * 1.96 / (22.0 + 1.96 * 1.96)).abs() < 1e-12);
        assert_eq!(Share::default().interval(), None);
    }
}
