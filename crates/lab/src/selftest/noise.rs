//! Is the noise of every study white and normal?
//!
//! Of `n` samples, all exact for independent standard normals:
//!
//! ```text
//! moments    mean of xᵏ, k = 1…4          expectation 0, 1, 0, 3; variance (1, 2, 15, 96)/n
//! tails      share beyond ±c, c = 1…5     binomial, Φ(−c)
//! products   mean of x(i)·x(i+d)          expectation 0; variance 1/n; neighbours, and lags one to four
//! ```
//!
//! Moments and products are held against normal limits: by Cramér's series the tail that chance takes there is off by `exp(γz³/6√n)` at most, `γ` the
//! skewness of one term, `z` the limit in standard deviations. It is largest for the fourth power, `γ = 10.1`: 1.07 at `n = 2²⁴`.

use super::chance::Tail;
use super::figure::Figure;
use statrs::distribution::{ContinuousCDF, Normal};
use switchback_noise::{BLOCK, StreamId, WhiteNoise, Width};

/// Samples drawn.
const SAMPLES: usize = 1 << 24;
/// `E[xᵏ]` and `E[x²ᵏ] − E[xᵏ]²`.
const MOMENTS: [(f64, f64); 4] = [(0.0, 1.0), (1.0, 2.0), (0.0, 15.0), (3.0, 96.0)];
/// Standard deviations beyond which samples are counted.
const TAILS: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];

/// Draws from the generator of the studies.
pub(super) fn figures(seed: u64) -> Vec<Figure> {
    let mut noise = WhiteNoise::new(Width::detect(), StreamId { seed, experiment: 0, replicate: 0 });
    let lanes = noise.lanes();
    examine((SAMPLES, lanes), |block| noise.fill(block))
}

/// The figures of so many samples of a generator that fills blocks; sample `t` of replicate `l` at `t·lanes + l`.
fn examine((samples, lanes): (usize, usize), mut fill: impl FnMut(&mut [f64])) -> Vec<Figure> {
    let distances: Vec<(String, usize)> = std::iter::once(("neighbouring replicates".to_owned(), 1))
        .filter(|_| lanes > 1)
        .chain((1..=4).map(|lag| (format!("samples {lag} apart"), lag * lanes)))
        .collect();
    let mut block = vec![0.0; BLOCK * lanes];
    let blocks = samples / block.len();
    let mut powers = [0.0; 4];
    let mut beyond = [[0_u64; TAILS.len()]; 2];
    let mut products = vec![0.0; distances.len()];
    for _ in 0..blocks {
        fill(&mut block);
        // Sums of a block first: added to the whole one by one, small terms would lose their last digits.
        let mut sums = [0.0; 4];
        for &x in &block {
            let square = x * x;
            for (sum, power) in sums.iter_mut().zip([x, square, square * x, square * square]) {
                *sum += power;
            }
            for (k, threshold) in TAILS.into_iter().enumerate() {
                beyond[0][k] += u64::from(x > threshold);
                beyond[1][k] += u64::from(x < -threshold);
            }
        }
        powers.iter_mut().zip(sums).for_each(|(all, sum)| *all += sum);
        for (all, (_, distance)) in products.iter_mut().zip(&distances) {
            *all += block.iter().zip(&block[*distance..]).map(|(x, y)| x * y).sum::<f64>();
        }
    }
    let count = blocks * block.len();
    let n = count as f64;
    let tail = Tail::of(MOMENTS.len() + 2 * TAILS.len() + distances.len());
    let mut figures = Vec::new();
    for (k, ((mean, variance), sum)) in MOMENTS.into_iter().zip(powers).enumerate() {
        let range = tail.about(mean, (variance / n).sqrt());
        figures.push(Figure::within(format!("moment {}", k + 1), sum / n, mean, range));
    }
    for (k, threshold) in TAILS.into_iter().enumerate() {
        let share = Normal::standard().sf(threshold);
        let range = tail.share(count as u64, share);
        for (side, counts) in ["above", "below −"].into_iter().zip(&beyond) {
            let blank = if side == "above" { " " } else { "" };
            let what = format!("share {side}{blank}{threshold} sd");
            figures.push(Figure::within(what, counts[k] as f64 / n, share, range));
        }
    }
    for ((what, distance), sum) in distances.iter().zip(products) {
        let pairs = (blocks * (block.len() - distance)) as f64;
        let range = tail.about(0.0, pairs.sqrt().recip());
        figures.push(Figure::within(format!("correlation of {what}"), sum / pairs, 0.0, range));
    }
    figures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::tests::{all_hold, some_fail};

    /// The right generator, with something done to every block.
    fn spoilt(samples: usize, mut spoil: impl FnMut(&mut [f64])) -> Vec<Figure> {
        let mut noise = WhiteNoise::new(Width::detect(), StreamId { seed: 3, experiment: 0, replicate: 0 });
        examine((samples, noise.lanes()), |block| {
            noise.fill(block);
            spoil(block);
        })
    }

    #[test]
    fn the_generator_passes_on_any_seed() {
        for seed in 1..=3 {
            all_hold(&figures(seed));
        }
    }

    #[test]
    fn a_wrong_variance_shows() {
        some_fail(&spoilt(SAMPLES, |block| block.iter_mut().for_each(|x| *x *= 1.002)), "moment 2");
    }

    #[test]
    fn a_mean_shows() {
        some_fail(&spoilt(SAMPLES, |block| block.iter_mut().for_each(|x| *x += 0.002)), "moment 1");
    }

    #[test]
    fn tails_that_are_cut_show() {
        some_fail(
            &spoilt(SAMPLES, |block| block.iter_mut().for_each(|x| *x = x.clamp(-4.0, 4.0))),
            "share above 4 sd",
        );
    }

    /// The sum of twelve uniforms has the first three moments of a normal, and short tails.
    #[test]
    fn a_sum_of_twelve_uniforms_shows() {
        let normal = Normal::standard();
        let sum_of_twelve = |block: &mut [f64]| {
            let uniforms: Vec<f64> = block.iter().map(|x| normal.cdf(*x)).collect();
            for (i, x) in block.iter_mut().enumerate() {
                *x = (0..12).map(|k| uniforms[(i + 37 * k) % uniforms.len()]).sum::<f64>() - 6.0;
            }
        };
        some_fail(&spoilt(SAMPLES / 16, sum_of_twelve), "moment 4");
    }

    #[test]
    fn memory_shows() {
        let mut last = Vec::new();
        let remembers = |block: &mut [f64]| {
            let fresh = block.to_vec();
            let lanes = block.len() / BLOCK;
            let share: f64 = 0.003;
            for i in lanes..block.len() {
                block[i] = share * fresh[i - lanes] + (1.0 - share * share).sqrt() * fresh[i];
            }
            last = fresh;
        };
        some_fail(&spoilt(SAMPLES, remembers), "correlation of samples 1 apart");
    }
}
