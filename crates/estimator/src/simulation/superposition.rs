//! Sufficient statistics of `y = z + σe` from those of `e` alone.

use super::design::PeriodicDesign;
use super::noise::Checkpoint;
use crate::estimators::pulse::{GroupedStatistics, PulseData};
use crate::linear::autocovariance;

/// All that the noise `e` contributes to the statistics of any pulse experiment of period `T`, up to lag `n`, over `N` samples.
///
/// ```text
/// products  Σ_t e(t−i) e(t−l)                         (n+1) × (n+1), rows first
/// folds     G_p,l = Σ_{t ≡ p mod T} e(t−l)            T × (n+1), rows first
/// counts    K_p = #{t : t ≡ p mod T}                  T
/// ```
///
/// It knows nothing of `σ`, `b`, the borders or the levels: one pass over the noise serves every cell of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseMoments {
    /// Largest lag `n`.
    pub order: usize,
    /// `K_p`.
    pub counts: Vec<f64>,
    /// Lag products.
    pub products: Vec<f64>,
    /// Lagged folds.
    pub folds: Vec<f64>,
}

impl NoiseMoments {
    /// The definition, for `e(t)` given from `t = −n` on: the first `n` entries precede the record. Slow; the oracle.
    ///
    /// # Panics
    /// If `e` has no more than `order` entries.
    pub fn from_samples(e: &[f64], order: usize, period: usize) -> Self {
        assert!(e.len() > order, "the record starts after the first n values");
        let width = order + 1;
        let mut moments = Self {
            order,
            counts: vec![0.0; period],
            products: vec![0.0; width * width],
            folds: vec![0.0; period * width],
        };
        for t in order..e.len() {
            let phase = (t - order) % period;
            moments.counts[phase] += 1.0;
            for l in 0..width {
                moments.folds[phase * width + l] += e[t - l];
                for i in 0..width {
                    moments.products[i * width + l] += e[t - i] * e[t - l];
                }
            }
        }
        moments
    }

    /// Reads the moments of period `plan.periods[period]` off what a pass over the noise recorded at one of its checkpoints.
    ///
    /// ```text
    /// G_p,l = F_{p−l} + Σ_{s=−l}^{−1} [s+l ≡ p] e(s) − Σ_{s=N−l}^{N−1} [s+l ≡ p] e(s)
    /// ```
    ///
    /// with `F` the plain fold: exact, both edges of the sum moved by `l`.
    pub fn from_checkpoint(head: &[f64], checkpoint: &Checkpoint, period: usize) -> Self {
        let order = head.len();
        let width = order + 1;
        let fold = &checkpoint.folds[period];
        let (period, samples) = (fold.len(), checkpoint.samples);
        let mut folds = vec![0.0; period * width];
        for l in 0..width {
            for p in 0..period {
                folds[p * width + l] = fold[(p + l * (period - 1)) % period];
            }
            for back in 1..=l {
                folds[(l - back) % period * width + l] += head[order - back];
                folds[(samples + l - back) % period * width + l] -= checkpoint.tail[order - back];
            }
        }
        let counts = (0..period).map(|p| visits(samples, period, p) as f64).collect();
        let products = checkpoint.lag_products.iter().copied().collect();
        Self { order, counts, products, folds }
    }

    /// The mean of these statistics over all noise: no folds, lag products from the autocovariances of `e = C/A w`, `w` unit white.
    ///
    /// `samples` need not be a whole number of periods; phases share it equally.
    pub fn expected(ar: &[f64], ma: &[f64], order: usize, period: usize, samples: f64) -> Self {
        let width = order + 1;
        let gamma = autocovariance(ar, ma, order);
        let products = (0..width * width).map(|k| samples * gamma[(k / width).abs_diff(k % width)]).collect();
        Self {
            order,
            counts: vec![samples / period as f64; period],
            products,
            folds: vec![0.0; period * width],
        }
    }

    /// The same over the first `samples` samples from phase 0 on, whatever is left of the last period included: the exact mean of
    /// the statistics of records of that length.
    pub fn expected_over(ar: &[f64], ma: &[f64], order: usize, period: usize, samples: usize) -> Self {
        let counts = (0..period).map(|p| visits(samples, period, p) as f64).collect();
        Self { counts, ..Self::expected(ar, ma, order, period, samples as f64) }
    }
}

/// Samples of phase `p` among the first `samples`.
pub(super) fn visits(samples: usize, period: usize, p: usize) -> usize {
    (samples + period - 1 - p) / period
}

/// The statistics of the pulse experiment `design` with noise-free response `z` (one period) and noise `sigma·e`.
///
/// ```text
/// S_q,l = Σ_{p ∈ q} (K_p z(p−l) + σ G_p,l)
/// P_i,l = Σ_p K_p z(p−i) z(p−l) + σ Σ_p (z(p−i) G_p,l + z(p−l) G_p,i) + σ² Σ_t e(t−i) e(t−l)
/// ```
///
/// Exact, phases modulo `T`; `O(T n²)` whatever the record's length.
///
/// # Panics
/// If orders or periods do not match.
pub fn superpose(design: &PeriodicDesign, z: &[f64], sigma: f64, noise: &NoiseMoments) -> PulseData {
    let (order, period) = (design.order, design.period());
    assert!(z.len() == period && noise.counts.len() == period, "response, noise and design have one period");
    assert_eq!(order, noise.order, "the noise was recorded up to the regression's order");
    let width = order + 1;
    let mut counts = vec![0.0; design.group_count()];
    let mut sums = vec![0.0; design.group_count() * width];
    let mut products: Vec<f64> = noise.products.iter().map(|p| sigma * sigma * p).collect();
    let mut window = vec![0.0; width];
    let mut phase_of = (0..width).map(|l| (period * width - l) % period).collect::<Vec<_>>();
    for p in 0..period {
        let folds = &noise.folds[p * width..(p + 1) * width];
        for l in 0..width {
            window[l] = z[phase_of[l]];
            phase_of[l] = if phase_of[l] + 1 == period { 0 } else { phase_of[l] + 1 };
        }
        let (group, count) = (design.groups[p], noise.counts[p]);
        counts[group] += count;
        for l in 0..width {
            sums[group * width + l] += count * window[l] + sigma * folds[l];
            for i in 0..width {
                products[i * width + l] +=
                    count * window[i] * window[l] + sigma * (window[i] * folds[l] + window[l] * folds[i]);
            }
        }
    }
    let statistics = GroupedStatistics::from_parts(order, counts, sums, products);
    PulseData::from_statistics(design.branch, design.levels.clone(), design.satellite, statistics)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::noise::{NoisePass, NoisePlan, StreamId, Width, samples};

    #[test]
    fn moments_of_the_pass_are_those_of_the_samples() {
        let plan = NoisePlan {
            ar: vec![-1.2, 0.5],
            ma: vec![0.3],
            lags: 3,
            periods: vec![1, 5, 14],
            checkpoints: vec![20, 333, 1000],
            burn_in: 100,
        };
        let open =
            samples(&plan, StreamId { seed: 7, experiment: 2, replicate: 4 }, 1000).expect("a valid plan");
        let mut pass = NoisePass::new(plan.clone(), Width::detect()).expect("a valid plan");
        pass.run(7, 2, 4..5, |_, record| {
            for (c, &n) in plan.checkpoints.iter().enumerate() {
                for (k, &period) in plan.periods.iter().enumerate() {
                    let fast = NoiseMoments::from_checkpoint(&record.head, &record.checkpoints[c], k);
                    let e = &open.e[plan.burn_in - 3..plan.burn_in + n];
                    let slow = NoiseMoments::from_samples(e, 3, period);
                    assert_eq!(fast.counts, slow.counts);
                    for (f, s) in
                        fast.folds.iter().chain(&fast.products).zip(slow.folds.iter().chain(&slow.products))
                    {
                        assert!((f - s).abs() < 1e-9, "N {n}, T {period}: {f} against {s}");
                    }
                }
            }
        });
    }
}
