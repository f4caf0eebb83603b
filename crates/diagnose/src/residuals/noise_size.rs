//! The size of the noise: does it depend on circumstances, or come and go?

use crate::least_squares::normal::Normal;
use crate::records::dataset::Dataset;
use crate::residuals::LAGS;
use switchback_model::spectrum::{autocorrelation, portmanteau};

/// Squares of the counted innovations about their mean, cut at nine variances so that a few outliers do not decide.
struct Sizes {
    /// Zero where a sample does not count.
    about_mean: Vec<Vec<f64>>,
    count: f64,
    /// Mean square.
    spread: f64,
}

impl Sizes {
    fn of(innovations: &[Vec<f64>]) -> Self {
        let counted = || innovations.iter().flatten().filter(|w| **w != 0.0);
        let count = counted().count().max(1) as f64;
        let variance = counted().map(|w| w * w).sum::<f64>() / count;
        let size = |w: f64| (w * w / variance).min(9.0);
        let mean = counted().map(|w| size(*w)).sum::<f64>() / count;
        let spread = counted().map(|w| (size(*w) - mean).powi(2)).sum::<f64>() / count;
        let about = |w: &f64| if *w == 0.0 { 0.0 } else { size(*w) - mean };
        let about_mean = innovations.iter().map(|scaled| scaled.iter().map(about).collect()).collect();
        Self { about_mean, count, spread }
    }

    /// McLeod–Li statistic over [`LAGS`] lags (McLeod, Li, J. Time Series Analysis 1983): `n·Σ r²`. What comes and goes
    /// leaves large errors in bursts, whatever distribution they have.
    fn mc_leod_li(&self) -> f64 {
        portmanteau(&self.about_mean, LAGS, self.count)
    }

    /// As many samples show as much as one: `1 + 2·Σ r`.
    fn correlation_time(&self) -> f64 {
        let r = autocorrelation(&self.about_mean, LAGS);
        1.0 + 2.0 * r[1..].iter().map(|r| r.max(0.0)).sum::<f64>()
    }
}

/// Chi-square of a regression of the innovations' size on circumstances.
fn scatter(dataset: &Dataset, innovations: &[Vec<f64>], sizes: &Sizes) -> (f64, usize) {
    const COLUMNS: usize = 7;
    let mut normal = Normal::new(COLUMNS);
    for ((scaled, w), size) in dataset.fit().zip(innovations).zip(&sizes.about_mean) {
        for (k, _) in w.iter().enumerate().filter(|(_, w)| **w != 0.0) {
            let t = scaled.from + k;
            let step = (scaled.v[t - 1] - scaled.v[t - 2]).abs();
            let y = scaled.y[t - 1];
            let moved = f64::from(u8::from(step > 0.0));
            let time = (scaled.clock + t) as f64 / dataset.total as f64;
            let pulsed = f64::from(u8::from(scaled.is_pulsed()));
            normal.add(&[1.0, y * y, y.abs(), moved, step, time, pulsed], size[k]);
        }
    }
    let gain = normal.factor(1e-9).map_or(0.0, |f| {
        let explained =
            f.solve(&normal.gradient).iter().zip(&normal.gradient).map(|(x, g)| x * g).sum::<f64>();
        explained / sizes.spread
    });
    (gain, COLUMNS)
}

/// Whether noise has the same size everywhere.
pub(crate) struct Homoscedasticity {
    /// Chi-square of its size against circumstances, and its degrees of freedom.
    pub(crate) scatter: (f64, usize),
    /// McLeod–Li statistic.
    pub(crate) bursts: f64,
}

impl Homoscedasticity {
    /// Of noise that is to have one size.
    pub(crate) fn of_all(dataset: &Dataset, innovations: &[Vec<f64>]) -> Self {
        let sizes = Sizes::of(innovations);
        Self { scatter: scatter(dataset, innovations, &sizes), bursts: sizes.mc_leod_li() }
    }

    /// Of noise with rare large errors: these may come in bursts, but not where the input does something.
    pub(crate) fn of_rare(dataset: &Dataset, innovations: &[Vec<f64>]) -> Self {
        let sizes = Sizes::of(innovations);
        let (gain, dof) = scatter(dataset, innovations, &sizes);
        Self { scatter: (gain / sizes.correlation_time(), dof), bursts: 0.0 }
    }
}

/// The counted innovations as they are: a mixture of distributions weighs a large error as if it were a small one.
pub(crate) fn unweighted(scaled: &[Vec<f64>], innovations: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let counted = |(w, s): (&f64, &f64)| if *s == 0.0 { 0.0 } else { *w };
    innovations.iter().zip(scaled).map(|(w, s)| w.iter().zip(s).map(counted).collect()).collect()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::*;

    /// Normal noise, five times as large in the last tenth of every four hundred samples.
    fn noise(seed: u64, in_bursts: bool) -> Vec<Vec<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let size = |t: usize| if in_bursts && t % 400 >= 360 { 5.0 } else { 1.0 };
        vec![(0..8000).map(|t| size(t) * rng.sample::<f64, _>(StandardNormal)).collect()]
    }

    #[test]
    fn bursts_show_and_even_noise_has_the_chi_square_of_its_lags() {
        let mean = (0..40).map(|seed| Sizes::of(&noise(seed, false)).mc_leod_li()).sum::<f64>() / 40.0;
        assert!((mean - LAGS as f64).abs() < 4.0 * (2.0 * LAGS as f64 / 40.0).sqrt(), "{mean}");
        assert!(Sizes::of(&noise(0, true)).mc_leod_li() > 1000.0);
    }

    #[test]
    fn samples_of_a_burst_describe_as_much_as_one() {
        assert!(Sizes::of(&noise(1, false)).correlation_time() < 1.5);
        assert!(Sizes::of(&noise(1, true)).correlation_time() > 5.0);
    }

    #[test]
    fn samples_that_do_not_count_have_no_size() {
        let scaled = [vec![0.5, 0.0, 2.0]];
        let innovations = [vec![1.0, 7.0, 4.0]];
        let counted = unweighted(&scaled, &innovations);
        assert_eq!(counted, [[1.0, 0.0, 4.0]]);
        assert_eq!(Sizes::of(&counted).about_mean[0][1], 0.0);
    }
}
