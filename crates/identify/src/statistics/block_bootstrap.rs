//! The mean of a correlated series, with an interval that allows for the correlation.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A mean with its 95 % interval from a block bootstrap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanInterval {
    /// The mean.
    pub mean: f64,
    /// Where 2.5 % of the resampled means lie below.
    pub low: f64,
    /// Where 2.5 % lie above.
    pub high: f64,
    /// Samples of the longest block.
    pub block: usize,
}

/// Resamples: the ends of the interval are then known to 0.35 % of probability.
const DRAWS: usize = 2000;

/// Blocks of a series at least, where no more are asked for: of fewer little is learnt.
const FEWEST: usize = 5;

/// Any number would do; a fixed one makes the interval a function of the data.
const SEED: u64 = 0x0b10_c4b0_0757_a9ed;

impl MeanInterval {
    /// From several series, none of which follows on another; `None` if they hold fewer than four blocks, or nothing.
    ///
    /// Each series is taken as a circle and blocks start anywhere in it, as many as make up its length (D. N. Politis, J. P. Romano, "A circular
    /// block-resampling procedure for stationary data", 1992). The block's length is that of least mean square error for the variance of a mean, after
    /// D. N. Politis, H. White, Econometric Reviews 23 (2004), doi 10.1081/ETC-120028836, with the correction of A. Patton, D. N. Politis, H. White
    /// (2009), doi 10.1080/07474930802459016.
    pub fn of(series: &[&[f64]]) -> Option<Self> {
        let count: usize = series.iter().map(|s| s.len()).sum();
        let block = series.iter().filter(|s| !s.is_empty()).map(|s| block_length(s)).max()?;
        if count < 4 * block { None } else { Self::from_blocks(series, |_| block) }
    }

    /// The same where a series is known to remember `memory` samples, however short it is: a block is no shorter than that, and no longer than a
    /// fifth of its series. `None` of nothing.
    pub fn of_remembering(series: &[&[f64]], memory: usize) -> Option<Self> {
        Self::from_blocks(series, |s| block_length(s).max(memory).clamp(1, (s.len() / FEWEST).max(1)))
    }

    fn from_blocks(series: &[&[f64]], block: impl Fn(&[f64]) -> usize) -> Option<Self> {
        let series: Vec<&[f64]> = series.iter().copied().filter(|s| !s.is_empty()).collect();
        let count: usize = series.iter().map(|s| s.len()).sum();
        if series.is_empty() || series.iter().any(|s| s.iter().any(|x| !x.is_finite())) {
            return None;
        }
        let sums: Vec<(CircularSums, usize)> =
            series.iter().map(|s| (CircularSums::of(s), block(s))).collect();
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        let mut means: Vec<f64> = (0..DRAWS)
            .map(|_| sums.iter().map(|(s, block)| s.resampled(*block, &mut rng)).sum::<f64>() / count as f64)
            .collect();
        means.sort_by(f64::total_cmp);
        let mean = series.iter().flat_map(|s| s.iter()).sum::<f64>() / count as f64;
        let block = sums.iter().map(|(_, block)| *block).max()?;
        Some(Self { mean, low: means[DRAWS / 40], high: means[DRAWS - 1 - DRAWS / 40], block })
    }
}

/// Running sums over a series closed to a circle.
struct CircularSums {
    until: Vec<f64>,
}

impl CircularSums {
    fn of(series: &[f64]) -> Self {
        let mut sum = 0.0;
        let run = series.iter().chain(series).map(|x| {
            sum += x;
            sum
        });
        Self { until: std::iter::once(0.0).chain(run).collect() }
    }

    /// Sum of a resampled series of the same length.
    fn resampled(&self, block: usize, rng: &mut ChaCha8Rng) -> f64 {
        let length = self.until.len() / 2;
        let (mut left, mut sum) = (length, 0.0);
        while left > 0 {
            let start = rng.random_range(0..length);
            let taken = block.min(left);
            sum += self.until[start + taken] - self.until[start];
            left -= taken;
        }
        sum
    }
}

/// Block length for a mean: `(2G²/D)^⅓ N^⅓` with `G = Σ λ(k/M)|k|R(k)` and `D = 4/3·(Σ λ(k/M)R(k))²`, `λ` the flat-top window, and `M` twice the lag
/// from which on the correlations are lost in chance.
fn block_length(series: &[f64]) -> usize {
    let n = series.len() as f64;
    let mean = series.iter().sum::<f64>() / n;
    let centred: Vec<f64> = series.iter().map(|x| x - mean).collect();
    let covariance =
        |k: usize| centred.iter().zip(centred.iter().skip(k)).map(|(x, z)| x * z).sum::<f64>() / n;
    let variance = covariance(0);
    let longest = (3.0 * n.sqrt()).min(n / 3.0).ceil().max(1.0) as usize;
    if variance.is_nan() || variance <= 0.0 {
        return 1;
    }
    let insignificant = 2.0 * (n.log10() / n).sqrt();
    let in_a_row = 5.max(n.log10().sqrt().ceil() as usize);
    let reach = n.sqrt().ceil() as usize + in_a_row;
    let mut quiet = 0;
    let mut last = reach;
    for k in 1..=reach {
        quiet = if (covariance(k) / variance).abs() < insignificant { quiet + 1 } else { 0 };
        if quiet == in_a_row {
            last = k - in_a_row;
            break;
        }
    }
    let window = 2 * last.max(1);
    let (mut spread, mut level) = (0.0, variance);
    for k in 1..=window.min(series.len() - 1) {
        let share = k as f64 / window as f64;
        let weight = if share <= 0.5 { 1.0 } else { 2.0 * (1.0 - share) };
        let covariance = covariance(k);
        spread += 2.0 * weight * k as f64 * covariance;
        level += 2.0 * weight * covariance;
    }
    let length = (1.5 * (spread / level).powi(2) * n).cbrt();
    if length.is_finite() { (length.ceil() as usize).clamp(1, longest) } else { longest }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coloured(seed: u64, count: usize, pole: f64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut x: Vec<f64> = (0..count).map(|_| rng.random_range(-1.0..1.0)).collect();
        for t in 1..count {
            x[t] += pole * x[t - 1];
        }
        x
    }

    #[test]
    fn the_interval_covers_the_true_mean_of_white_and_of_coloured_noise() {
        for pole in [0.0, 0.8] {
            let covered = (0..300u64)
                .filter(|&seed| {
                    let (one, other) = (coloured(seed, 1500, pole), coloured(seed + 7000, 500, pole));
                    let found = MeanInterval::of(&[&one, &other]).expect("enough blocks");
                    found.low <= 0.0 && 0.0 <= found.high
                })
                .count();
            // 285 expected, standard deviation 3.8; blocks of a finite record leave out some of the correlation.
            assert!((261..=297).contains(&covered), "pole {pole}: {covered} of 300");
        }
    }

    #[test]
    fn longer_memory_takes_longer_blocks() {
        let length = |pole| block_length(&coloured(1, 4000, pole));
        assert!(length(0.0) <= 8, "{}", length(0.0));
        assert!(length(0.9) > 3 * length(0.3), "{} and {}", length(0.9), length(0.3));
    }

    #[test]
    fn a_series_too_short_for_its_memory_gives_no_interval() {
        let drift: Vec<f64> = (0..60).map(f64::from).collect();
        assert_eq!(MeanInterval::of(&[&drift]), None);
        assert_eq!(MeanInterval::of(&[&[1.0, 2.0, 1.5]]), None);
        assert_eq!(MeanInterval::of(&[]), None);
    }

    #[test]
    fn blocks_have_the_length_of_least_error() {
        // (3/2·(G/D)²·N)^⅓ with G = Σ|k|R(k) = 2ρ/(1−ρ)²·R(0) and ΣR(k) = (1+ρ)/(1−ρ)·R(0).
        let rho: f64 = 0.9;
        let ratio = (2.0 * rho / (1.0 - rho).powi(2)) / ((1.0 + rho) / (1.0 - rho));
        let best = (1.5 * ratio.powi(2) * 4000.0).cbrt();
        let found = block_length(&coloured(1, 4000, rho)) as f64;
        assert!((0.5 * best..2.0 * best).contains(&found), "{found} {best}");
    }

    #[test]
    fn a_memory_that_is_known_lengthens_the_blocks_up_to_a_fifth_of_the_series() {
        let noise = coloured(3, 500, 0.0);
        let block = |memory| MeanInterval::of_remembering(&[&noise], memory).expect("an interval").block;
        assert!(block(1) < 20);
        assert_eq!([block(60), block(usize::MAX)], [60, 100]);
        let steps = [&[1.0; 50][..], &[3.0; 150]];
        let found = MeanInterval::of_remembering(&steps, 7).expect("an interval");
        assert!((found.low - 2.5).abs() < 1e-12 && (found.high - 2.5).abs() < 1e-12, "{found:?}");
        assert_eq!(MeanInterval::of_remembering(&[], 1), None);
        assert_eq!(MeanInterval::of_remembering(&[&[f64::NAN]], 1), None);
    }

    #[test]
    fn resampling_leaves_a_constant_alone() {
        let found = MeanInterval::of(&[&[2.0; 50]]).expect("enough blocks");
        assert!((found.low - 2.0).abs() < 1e-12 && (found.high - 2.0).abs() < 1e-12);
    }
}
