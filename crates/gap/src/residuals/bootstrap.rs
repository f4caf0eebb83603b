//! The mean of terms that hang together in time, with its error: a block bootstrap.
//!
//! Blocks of a record are drawn anew, each beginning anywhere, the record closed to a ring. Their length is that of Politis and White,
//! "Automatic block-length selection for the dependent bootstrap" (Econometric Reviews 23, 2004; corrected by Patton, Politis and White,
//! 28, 2009), from the autocorrelation of the terms themselves:
//!
//! ```text
//! L = (2·G²/D)^⅓·n^⅓,   G = Σ λ(k/M)·|k|·R(k),   D = 4/3·(Σ λ(k/M)·R(k))²,   λ(x) = min(1, 2(1 − |x|)) for |x| ≤ 1
//! ```
//!
//! with `M` twice the lag from which five autocorrelations and more are not told from zero. A block is no shorter than what the caller
//! knows of the memory, and no longer than a fifth of the record.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Records drawn anew: the ends of a 95 % interval are then the 25th of either side.
const DRAWS: usize = 1000;
/// Blocks that a record has at least: of fewer nothing is learnt.
const FEWEST: usize = 5;
/// Autocorrelations in a row that are not told from zero, and the multiple of `√(lg n/n)` that tells one from zero, as by the authors.
const IN_A_ROW: usize = 5;
const TOLD: f64 = 2.0;

/// A mean and its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mean {
    pub(crate) estimate: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// The mean over records of terms that hang together within each; `memory` is the least length of a block, samples.
///
/// The answer hangs on the terms and `seed` alone. Nothing where there are no terms.
pub(crate) fn mean(records: &[Vec<f64>], memory: usize, seed: u64) -> Option<Mean> {
    let count: usize = records.iter().map(Vec::len).sum();
    if count == 0 || records.iter().flatten().any(|x| !x.is_finite()) {
        return None;
    }
    let rings: Vec<Ring> = records.iter().filter(|r| !r.is_empty()).map(|r| Ring::new(r, memory)).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut drawn: Vec<f64> = (0..DRAWS)
        .map(|_| rings.iter().map(|ring| ring.drawn(&mut rng)).sum::<f64>() / count as f64)
        .collect();
    drawn.sort_by(f64::total_cmp);
    let estimate = records.iter().flatten().sum::<f64>() / count as f64;
    let end = DRAWS / 40;
    Some(Mean { estimate, low: drawn[end], high: drawn[DRAWS - 1 - end] })
}

/// A record closed to a ring, as running sums.
struct Ring {
    /// Sum of the terms before each place, twice round.
    sums: Vec<f64>,
    length: usize,
    block: usize,
}

impl Ring {
    fn new(terms: &[f64], memory: usize) -> Self {
        let n = terms.len();
        let mut sums = Vec::with_capacity(2 * n + 1);
        sums.push(0.0);
        let mut sum = 0.0;
        for x in terms.iter().chain(terms) {
            sum += x;
            sums.push(sum);
        }
        let block = block_length(terms).max(memory).clamp(1, (n / FEWEST).max(1));
        Self { sums, length: n, block }
    }

    /// The sum over a record drawn anew.
    fn drawn(&self, rng: &mut ChaCha8Rng) -> f64 {
        let (mut left, mut sum) = (self.length, 0.0);
        while left > 0 {
            let length = self.block.min(left);
            let from = rng.random_range(0..self.length);
            sum += self.sums[from + length] - self.sums[from];
            left -= length;
        }
        sum
    }
}

/// The length of a block by the autocorrelation of the terms.
fn block_length(terms: &[f64]) -> usize {
    let n = terms.len();
    let mean = terms.iter().sum::<f64>() / n as f64;
    let centred: Vec<f64> = terms.iter().map(|x| x - mean).collect();
    let covariance = |k: usize| centred.iter().zip(&centred[k..]).map(|(x, y)| x * y).sum::<f64>() / n as f64;
    let variance = covariance(0);
    if variance <= 0.0 {
        return 1;
    }
    let told = TOLD * ((n as f64).log10() / n as f64).sqrt();
    let longest = n / (2 * FEWEST);
    let (mut row, mut last) = (0, 0);
    let mut known = vec![variance];
    for k in 1..=longest {
        known.push(covariance(k));
        row = if known[k].abs() < told * variance { row + 1 } else { 0 };
        if row == 0 {
            last = k;
        }
        if row == IN_A_ROW {
            break;
        }
    }
    let bandwidth = (2 * last).max(1);
    let (mut weighted, mut plain) = (0.0, variance);
    for k in 1..=bandwidth.min(n - 1) {
        let r = known.get(k).copied().unwrap_or_else(|| covariance(k));
        let window = (2.0 * (1.0 - k as f64 / bandwidth as f64)).min(1.0);
        weighted += 2.0 * window * k as f64 * r;
        plain += 2.0 * window * r;
    }
    let spread = 4.0 / 3.0 * plain * plain;
    (2.0 * weighted * weighted / spread.max(1e-300) * n as f64).cbrt().ceil().min(n as f64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::white;

    /// Terms of a first-order memory, mean zero.
    fn remembering(pole: f64, n: usize, noise: &mut impl FnMut() -> f64) -> Vec<f64> {
        let mut x = 0.0;
        (0..n + 200)
            .map(|_| {
                x = pole * x + noise();
                x
            })
            .skip(200)
            .collect()
    }

    #[test]
    fn the_interval_of_terms_that_hang_together_holds_their_mean() {
        for (pole, n) in [(0.0, 400), (0.9, 2000)] {
            let mut noise = white();
            let holds = (0..300).filter(|&seed| {
                let found = mean(&[remembering(pole, n, &mut noise)], 1, seed).expect("terms");
                found.low <= 0.0 && 0.0 <= found.high
            });
            // 95 % of 300 but for four standard deviations, and a bootstrap of correlated terms is a little narrow.
            let share = holds.count() as f64 / 300.0;
            assert!((0.88..=0.995).contains(&share), "pole {pole}: {share}");
        }
    }

    #[test]
    fn blocks_grow_with_the_memory_of_the_terms() {
        let length = |pole: f64| block_length(&remembering(pole, 4000, &mut white()));
        assert!(length(0.0) < 8, "{}", length(0.0));
        // The optimum for this pole is (2·G²/D·n)^⅓ with G = 2ρ/(1−ρ)²·R₀ and Σ R = (1+ρ)/(1−ρ)·R₀.
        let rho: f64 = 0.9;
        let (g, sum) = (2.0 * rho / (1.0 - rho).powi(2), (1.0 + rho) / (1.0 - rho));
        let best = (1.5 * (g / sum).powi(2) * 4000.0).cbrt();
        assert!((0.5 * best..2.0 * best).contains(&(length(rho) as f64)), "{} {best}", length(rho));
    }

    #[test]
    fn records_are_drawn_each_by_itself_and_the_answer_is_that_of_the_seed() {
        let records = [vec![1.0; 50], vec![3.0; 150]];
        let found = mean(&records, 7, 3).expect("terms");
        assert_eq!((found.low, found.high), (2.5, 2.5));
        assert_eq!(mean(&[], 1, 1), None);
        assert_eq!(mean(&[vec![f64::NAN]], 1, 1), None);
        let mut noise = white();
        let one = vec![remembering(0.5, 500, &mut noise)];
        assert_eq!(mean(&one, 1, 5), mean(&one, 1, 5));
    }
}
