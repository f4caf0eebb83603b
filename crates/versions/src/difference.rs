//! Differences of two versions, from pairs of replicates.
//!
//! ```text
//! x, y           errors of the baseline and of the new version on the same record, of one parameter
//! bias           (ȳ − x̄) / s_x
//! sd             ln(s_y / s_x)
//! ```
//!
//! Both are functions of means over replicates. Their standard errors are those of the means of what a replicate adds to them (influence function):
//! for the bias `(y − x − (ȳ − x̄))/s_x − ½ (ȳ − x̄)/s_x ((x − x̄)²/s_x² − 1)`, for the standard deviation
//! `½ ((y − ȳ)²/s_y² − (x − x̄)²/s_x²)`. They know how the two go together: where both do nearly the same, little is left.
//! Of a replicate and its antithetic partner the mean counts, in which all that changes its sign with the noise cancels.

/// A figure with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Estimate {
    pub(super) value: f64,
    pub(super) se: f64,
}

/// Errors of one parameter in a replicate, one entry a sign of the noise at which both versions have an estimate.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PairedErrors(Vec<[f64; 2]>);

impl PairedErrors {
    /// Of the baseline and the new version; `None` where no sign has both.
    pub(super) fn of(signs: impl IntoIterator<Item = [Option<f64>; 2]>) -> Option<Self> {
        let both = signs.into_iter().filter_map(|[x, y]| Some([x?, y?]));
        let pairs: Vec<[f64; 2]> = both.collect();
        (!pairs.is_empty()).then_some(Self(pairs))
    }

    /// The mean of a figure over the signs.
    pub(super) fn mean(&self, figure: impl Fn([f64; 2]) -> f64) -> f64 {
        self.0.iter().map(|&pair| figure(pair)).sum::<f64>() / self.0.len() as f64
    }
}

/// Means over replicates of the errors of one parameter, and of their squares.
struct Moments<'p> {
    pairs: &'p [PairedErrors],
    means: [f64; 2],
    variances: [f64; 2],
    /// `ȳ − x̄`, from the differences: the same estimates twice differ by nothing.
    difference: f64,
}

impl<'p> Moments<'p> {
    fn of(pairs: &'p [PairedErrors]) -> Self {
        let over = |figure: &dyn Fn([f64; 2]) -> f64| {
            pairs.iter().map(|pair| pair.mean(figure)).sum::<f64>() / pairs.len() as f64
        };
        let means = [0, 1].map(|k| over(&|pair| pair[k]));
        let variances = [0, 1].map(|k| over(&|pair| (pair[k] - means[k]).powi(2)));
        Self { pairs, means, variances, difference: over(&|[x, y]| y - x) }
    }

    /// The square of the distance from the mean in units of the variance, less one.
    fn spread(&self, pair: &PairedErrors, k: usize) -> f64 {
        pair.mean(|pair| (pair[k] - self.means[k]).powi(2)) / self.variances[k] - 1.0
    }

    fn estimate(&self, value: f64, influence: impl Fn(&PairedErrors) -> f64) -> Estimate {
        let count = self.pairs.len() as f64;
        let squares: f64 = self.pairs.iter().map(|pair| influence(pair).powi(2)).sum();
        Estimate { value, se: (squares / (count - 1.0) / count).sqrt() }
    }
}

/// The difference of bias in standard deviations of the baseline. Infinite, or no number, where that has none.
pub(super) fn bias(pairs: &[PairedErrors]) -> Estimate {
    let moments = Moments::of(pairs);
    if moments.difference == 0.0 && pairs.iter().all(|pair| pair.mean(|[x, y]| (y - x).abs()) == 0.0) {
        return Estimate { value: 0.0, se: 0.0 };
    }
    let sd = moments.variances[0].sqrt();
    let value = moments.difference / sd;
    moments.estimate(value, |pair| {
        (pair.mean(|[x, y]| y - x) - moments.difference) / sd - 0.5 * value * moments.spread(pair, 0)
    })
}

/// The logarithm of the ratio of standard deviations. Infinite, or no number, where one has none.
pub(super) fn sd(pairs: &[PairedErrors]) -> Estimate {
    let moments = Moments::of(pairs);
    let [x, y] = moments.variances;
    if x == y && pairs.iter().all(|pair| pair.mean(|[x, y]| (y - x).abs()) == 0.0) {
        return Estimate { value: 0.0, se: 0.0 };
    }
    let value = 0.5 * (y / x).ln();
    moments.estimate(value, |pair| 0.5 * (moments.spread(pair, 1) - moments.spread(pair, 0)))
}

/// Of replicates at which exactly one version fails: the baseline's number and the new one's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Discordant {
    pub(super) baseline: usize,
    pub(super) new: usize,
}

impl Discordant {
    /// How likely so uneven numbers are where both fail as often: exact, two-sided (Q. McNemar, *Psychometrika* 12 (1947), pp. 153–157).
    pub(super) fn p_value(self) -> f64 {
        let (count, least) = (self.baseline + self.new, self.baseline.min(self.new));
        // Chances of 0 … least of `count` at one half, by their logarithms.
        let mut logarithm = -(count as f64) * std::f64::consts::LN_2;
        let mut tail = logarithm.exp();
        for k in 1..=least {
            logarithm += ((count - k + 1) as f64 / k as f64).ln();
            tail += logarithm.exp();
        }
        (2.0 * tail).min(1.0)
    }

    /// The difference of the shares of failures, with an error that is not zero where none was seen: half a replicate more on either side (A. Agresti,
    /// Y. Min, *Statistics in Medicine* 24 (2005), pp. 729–740).
    pub(super) fn estimate(self, replicates: usize) -> Estimate {
        let (count, difference) = (replicates as f64, self.new as f64 - self.baseline as f64);
        let either = (self.new + self.baseline) as f64 + 1.0;
        let adjusted = count + 2.0;
        let variance = (either - difference * difference / adjusted) / (adjusted * adjusted);
        Estimate { value: difference / count, se: variance.max(0.0).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_noise::{StreamId, white_samples};

    fn noise(experiment: u32, replicate: u32, count: usize) -> Vec<f64> {
        white_samples(StreamId { seed: 4, experiment, replicate }, count)
    }

    /// Pairs whose new version is off by `shift`, scatters `factor` times as much and has noise of its own.
    fn pairs(replicate: u32, (shift, factor, own): (f64, f64, f64)) -> Vec<PairedErrors> {
        let (x, more) = (noise(0, replicate, 200), noise(1, replicate, 200));
        let pair = |(x, more): (&f64, &f64)| {
            let pair =
                |sign: f64| [Some(2.0 * sign * x), Some(2.0 * (sign * x * factor + shift) + own * more)];
            PairedErrors::of([pair(1.0), pair(-1.0)]).expect("both")
        };
        x.iter().zip(&more).map(pair).collect()
    }

    #[test]
    fn differences_are_found_and_their_errors_are_right() {
        for (law, of_bias, of_sd) in [
            ((0.1, 1.0, 0.5), 0.1, 0.5 * (1.0_f64 + 0.0625).ln()),
            ((0.0, 1.2, 0.5), 0.0, 0.5 * (1.44_f64 + 0.0625).ln()),
            ((-0.3, 0.9, 0.2), -0.3, 0.5 * (0.81_f64 + 0.01).ln()),
        ] {
            for (figure, truth) in [(bias as fn(&[PairedErrors]) -> Estimate, of_bias), (sd, of_sd)] {
                let found: Vec<Estimate> = (0..800).map(|r| figure(&pairs(r, law))).collect();
                let count = found.len() as f64;
                let mean = found.iter().map(|e| e.value).sum::<f64>() / count;
                let variance = found.iter().map(|e| (e.value - mean).powi(2)).sum::<f64>() / (count - 1.0);
                let reported = (found.iter().map(|e| e.se * e.se).sum::<f64>() / count).sqrt();
                // Of order 1/R beside errors of order 1/√R.
                assert!(
                    (mean - truth).abs() < 4.0 * (variance / count).sqrt() + 0.002,
                    "{law:?}: {mean} {truth}"
                );
                assert!(
                    (reported / variance.sqrt() - 1.0).abs() < 0.1,
                    "{law:?}: {reported} {}",
                    variance.sqrt()
                );
            }
        }
    }

    #[test]
    fn the_same_estimates_differ_by_nothing_and_a_constant_shift_is_known_exactly() {
        let same = pairs(0, (0.0, 1.0, 0.0));
        assert_eq!(
            (bias(&same), sd(&same)),
            (Estimate { value: 0.0, se: 0.0 }, Estimate { value: 0.0, se: 0.0 })
        );
        let shifted = pairs(0, (0.1, 1.0, 0.0));
        let found = bias(&shifted);
        assert!((found.value - 0.1).abs() < 0.01 && found.se < 0.008, "{found:?}");
        assert!(sd(&shifted).value.abs() < 1e-12);
    }

    #[test]
    fn without_any_spread_there_is_no_unit() {
        let constant: Vec<PairedErrors> =
            (0..40).map(|_| PairedErrors::of([[Some(1.0), Some(2.0)]]).expect("both")).collect();
        assert!(!bias(&constant).value.is_finite());
        assert!(PairedErrors::of([[Some(1.0), None], [None, Some(2.0)]]).is_none());
    }

    #[test]
    fn uneven_failures_have_their_binomial_chance() {
        let p = |baseline, new| Discordant { baseline, new }.p_value();
        assert!((p(0, 10) - 2.0 / 1024.0).abs() < 1e-15);
        assert!((p(1, 9) - 22.0 / 1024.0).abs() < 1e-15);
        assert_eq!((p(0, 0), p(5, 5)), (1.0, 1.0));
        assert!(p(0, 5000) < 1e-300);
        let found = Discordant { baseline: 1, new: 4 }.estimate(400);
        assert!((found.value - 0.0075).abs() < 1e-15 && (0.004..0.007).contains(&found.se), "{found:?}");
    }
}
