//! Sufficient statistics of `y = z + σe` from those of `e` alone.

use super::design::PeriodicDesign;
use crate::pulse::{Folds, GroupedStatistics, PulseData};
use switchback_model::linear::autocovariance;
use switchback_noise::Checkpoint;

/// All that the noise `e` contributes to the statistics of any pulse experiment of period `T`, up to lag `n`, over `N` samples.
///
/// ```text
/// products  Σ_t e(t−i) e(t−l)                         (n+1) × (n+1), rows first
/// folds     G_p,l = Σ_{t ≡ p mod T} e(t−l)            T × (n+1), rows first
/// counts    K_p = #{t : t ≡ p mod T}                  T
/// left      Σ_t e(t) e(t−k) − Σ_p G_p,0 G_p,k / K_p   L+1, k = 0…L
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
    /// What the folds leave of the products: see [`Folds`].
    pub left: Vec<f64>,
}

impl NoiseMoments {
    /// The definition, for `e(t)` given from `t = −n` on: the first `n` entries precede the record. Slow; the oracle.
    ///
    /// # Panics
    /// If `e` has no more than `order` entries.
    pub fn from_samples(e: &[f64], order: usize, period: usize) -> Self {
        Self::from_samples_after(e, order, order, period)
    }

    /// The same for `e(t)` given from `t = −L` on, `L ≥ n` lags of what the folds leave.
    ///
    /// # Panics
    /// If `e` has no more than `lags` entries.
    pub(crate) fn from_samples_after(e: &[f64], lags: usize, order: usize, period: usize) -> Self {
        assert!(e.len() > lags && lags >= order, "the record starts after the first L values");
        let width = order + 1;
        let mut moments = Self {
            order,
            counts: vec![0.0; period],
            products: vec![0.0; width * width],
            folds: vec![0.0; period * width],
            left: vec![0.0; lags + 1],
        };
        let mut lagged = vec![0.0; period * (lags + 1)];
        for t in lags..e.len() {
            let phase = (t - lags) % period;
            moments.counts[phase] += 1.0;
            for k in 0..=lags {
                lagged[phase * (lags + 1) + k] += e[t - k];
                moments.left[k] += e[t] * e[t - k];
            }
            for l in 0..width {
                moments.folds[phase * width + l] += e[t - l];
                for i in 0..width {
                    moments.products[i * width + l] += e[t - i] * e[t - l];
                }
            }
        }
        for (fold, count) in
            lagged.chunks_exact(lags + 1).zip(&moments.counts).filter(|(_, count)| **count > 0.0)
        {
            moments.left.iter_mut().zip(fold).for_each(|(left, lagged)| *left -= fold[0] * lagged / count);
        }
        moments
    }

    /// Reads the moments of period `plan.periods[period]` off what a pass over the noise recorded at one of its checkpoints.
    ///
    /// ```text
    /// G_p,l = F_{p−l} + Σ_{s=−l}^{−1} [s+l ≡ p] e(s) − Σ_{s=N−l}^{N−1} [s+l ≡ p] e(s)
    /// ```
    ///
    /// with `F` the plain fold: exact, both edges of the sum moved by `l`. The pass must have recorded as many lags as the order, or more: all of
    /// them enter what the folds leave.
    ///
    /// # Panics
    /// If it recorded fewer.
    pub fn from_checkpoint(order: usize, head: &[f64], checkpoint: &Checkpoint, period: usize) -> Self {
        let lags = head.len();
        assert!(order <= lags, "the pass records the lags of the regression");
        let width = order + 1;
        let fold = &checkpoint.folds[period];
        let (period, samples) = (fold.len(), checkpoint.samples);
        let lagged = |l: usize| {
            let mut lagged: Vec<f64> = (0..period).map(|p| fold[(p + l * (period - 1)) % period]).collect();
            for back in 1..=l {
                lagged[(l - back) % period] += head[lags - back];
                lagged[(samples + l - back) % period] -= checkpoint.tail[lags - back];
            }
            lagged
        };
        let counts: Vec<f64> = (0..period).map(|p| visits(samples, period, p) as f64).collect();
        let mut folds = vec![0.0; period * width];
        let mut left = Vec::with_capacity(lags + 1);
        for l in 0..=lags {
            let lagged = lagged(l);
            let mut of_folds = 0.0;
            for p in 0..period {
                if l < width {
                    folds[p * width + l] = lagged[p];
                }
                if counts[p] > 0.0 {
                    of_folds += fold[p] / counts[p] * lagged[p];
                }
            }
            left.push(checkpoint.lag_products[(0, l)] - of_folds);
        }
        let products = (0..width * width).map(|k| checkpoint.lag_products[(k / width, k % width)]).collect();
        Self { order, counts, products, folds, left }
    }

    /// The mean of these statistics over all noise: no folds, lag products from the autocovariances of `e = C/A w`, `w` unit white; what the folds
    /// leave, but for terms that vanish beside the number of samples.
    ///
    /// `samples` need not be a whole number of periods; phases share it equally.
    pub fn expected(ar: &[f64], ma: &[f64], order: usize, period: usize, samples: f64) -> Self {
        let width = order + 1;
        let gamma = autocovariance(ar, ma, Folds::lags(order));
        let products = (0..width * width).map(|k| samples * gamma[(k / width).abs_diff(k % width)]).collect();
        Self {
            order,
            counts: vec![samples / period as f64; period],
            products,
            folds: vec![0.0; period * width],
            left: gamma.iter().map(|gamma| (samples - period as f64).max(0.0) * gamma).collect(),
        }
    }

    /// The same over the first `samples` samples from phase 0 on, whatever is left of the last period included: the exact mean of
    /// the statistics of records of that length, but for what the folds leave.
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
    let mut means = vec![0.0; period];
    let mut phase_of = (0..width).map(|l| (period * width - l) % period).collect::<Vec<_>>();
    for p in 0..period {
        let folds = &noise.folds[p * width..(p + 1) * width];
        for l in 0..width {
            window[l] = z[phase_of[l]];
            phase_of[l] = if phase_of[l] + 1 == period { 0 } else { phase_of[l] + 1 };
        }
        let (group, count) = (design.groups[p], noise.counts[p]);
        means[p] = window[0] + if count > 0.0 { sigma * folds[0] / count } else { 0.0 };
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
    let folds = Folds {
        visits: design.visits(),
        means,
        within: noise.left.iter().map(|left| sigma * sigma * left).collect(),
        samples: statistics.samples(),
    };
    PulseData::from_statistics(design.branch, design.levels.clone(), design.satellite, statistics)
        .with_folds(Some(folds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_noise::{NoisePass, NoisePlan, StreamId, Width, samples};

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
                    let fast = NoiseMoments::from_checkpoint(2, &record.head, &record.checkpoints[c], k);
                    let e = &open.e[plan.burn_in - 3..plan.burn_in + n];
                    let slow = NoiseMoments::from_samples_after(e, 3, 2, period);
                    assert_eq!(fast.counts, slow.counts);
                    for (f, s) in [&fast.folds, &fast.products, &fast.left]
                        .into_iter()
                        .flatten()
                        .zip([&slow.folds, &slow.products, &slow.left].into_iter().flatten())
                    {
                        assert!((f - s).abs() < 1e-9, "N {n}, T {period}: {f} against {s}");
                    }
                }
            }
        });
    }
}
