//! Running sums over replicates, and the performance measures they give.

use super::Measured;
use super::quantile::normal_quantile_975;

/// What one replicate reports one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReplicateError {
    /// `θ̂ − θ`.
    pub error: f64,
    /// Standard error that the method reports.
    pub se: f64,
    /// First-order part of the error (see [`crate::pulse::Limit`]): the control variate.
    pub first_order: Option<f64>,
    /// What is known of the second-order part: it joins the control variate of the bias.
    pub second_order: f64,
    /// The exact variance of the first-order part, where it is known.
    pub first_order_variance: Option<f64>,
}

impl ReplicateError {
    /// One where the interval holds the truth, else zero.
    fn is_covered(&self) -> f64 {
        f64::from(self.error.abs() <= normal_quantile_975() * self.se)
    }

    /// What the control variates leave of the error, of its square and of its coverage; `None` where there are none.
    fn remainders(&self) -> Option<[f64; 3]> {
        let first = self.first_order?;
        let of_coverage = self.first_order_variance.map_or(0.0, |variance| {
            let within = normal_quantile_975() * normal_quantile_975() * variance;
            self.is_covered() - f64::from(first * first <= within)
        });
        let beyond_first = self.error - first;
        Some([beyond_first - self.second_order, beyond_first * (self.error + first), of_coverage])
    }
}

/// What is known of the control variate of a parameter without any replicate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KnownControl {
    /// The mean of its first- and second-order parts together.
    pub mean: f64,
    /// The variance of the first-order part, whose mean is then zero.
    pub first_order_variance: Option<f64>,
    /// The chance that the first-order part lies within 1.96 of its standard deviations.
    pub first_order_coverage: Option<f64>,
}

/// Terms that a replicate adds to the sums of a parameter: error and its powers to the fourth, variance and its square, coverage, remainder
/// and its square, remainder of the square and its square, remainder of the coverage and its square.
pub(super) const TERMS: usize = 13;

/// Sums over replicates, from which every measure follows. Constant memory; [`ErrorSums::merge`] adds two.
///
/// Plain sums suffice: errors are taken about the truth, so no large mean cancels. Where an estimate is inconsistent and its bias exceeds
/// its standard deviation a thousandfold, the latter still keeps ten digits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ErrorSums {
    /// Replicates so far.
    pub(super) count: f64,
    /// … of which the first-order part is known.
    pub(super) controlled: f64,
    /// The sums of their terms.
    pub(super) terms: [f64; TERMS],
}

/// Performance of an estimator of one parameter, after Morris, White and Crowther, "Using simulation studies to evaluate
/// statistical methods", Statistics in Medicine 38 (2019), Table 6, doi 10.1002/sim.8086; `R` replicates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Performance {
    /// Mean error; MCSE `sd/√R`.
    pub bias: Measured,
    /// Mean error with the control variate taken out and its mean put in; MCSE the remainder's `sd/√R`.
    pub bias_controlled: Option<Measured>,
    /// Empirical standard deviation; MCSE `sd/√(2(R−1))`.
    pub sd: Measured,
    /// The same from `E[e² − c²] + E[c²]`, `c` the first-order part, where `E[c²]` is known.
    pub sd_controlled: Option<Measured>,
    /// Mean squared error; MCSE from the spread of the squares.
    pub mse: Measured,
    /// Share of nominal 95 % intervals that hold the truth; MCSE binomial.
    pub coverage: Measured,
    /// The same with the share of first-order parts within 1.96 of their standard deviations taken out and its expectation put in
    /// (R. Davidson and J. G. MacKinnon, "Regression-based methods for using control variates in Monte Carlo experiments", Journal of
    /// Econometrics 54 (1992), 203–222, with their coefficient at its asymptotic value 1, so that it has no error); MCSE the remainder's.
    pub coverage_controlled: Option<Measured>,
    /// Root mean square of the reported standard errors; MCSE by the delta method.
    pub model_sd: Measured,
    /// `model_sd/sd − 1`; MCSE by the delta method.
    pub model_sd_relative_error: Measured,
}

impl ErrorSums {
    /// Adds one replicate.
    pub fn push(&mut self, replicate: ReplicateError) {
        self.push_pair(replicate, None);
    }

    /// Adds one replicate with its antithetic partner, the same noise with its sign changed.
    ///
    /// The partner joins the remainders that the control variates leave, each then the mean of two: parts of odd order in the noise cancel, and
    /// with them most of what is left of the bias beyond the second order, of the square and of the coverage beyond the first. All else is of
    /// the replicate alone, so that replicates stay independent of each other.
    ///
    /// Antithetic variates: J. M. Hammersley and K. W. Morton, "A new Monte Carlo technique: antithetic variates", Mathematical Proceedings of
    /// the Cambridge Philosophical Society 52 (1956), 449–475.
    pub fn push_pair(&mut self, replicate: ReplicateError, mirrored: Option<ReplicateError>) {
        let ReplicateError { error, se, .. } = replicate;
        let square = error * error;
        let of_estimate = [error, square, square * error, square * square, se * se, se * se * se * se];
        let (estimate, remainders) = self.terms.split_at_mut(of_estimate.len() + 1);
        let added = of_estimate.into_iter().chain([replicate.is_covered()]);
        estimate.iter_mut().zip(added).for_each(|(sum, term)| *sum += term);
        self.count += 1.0;
        let Some(own) = replicate.remainders() else { return };
        let partner = mirrored.and_then(|mirrored| mirrored.remainders()).unwrap_or(own);
        self.controlled += 1.0;
        for (sums, (own, partner)) in remainders.chunks_exact_mut(2).zip(own.into_iter().zip(partner)) {
            let mean = (own + partner) * 0.5;
            sums[0] += mean;
            sums[1] += mean * mean;
        }
    }

    /// Adds the sums of other replicates.
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.controlled += other.controlled;
        self.terms.iter_mut().zip(other.terms).for_each(|(into, from)| *into += from);
    }

    /// Error and reported standard error of the one replicate that was added; `None` if there is none, or more.
    pub fn single(&self) -> Option<(f64, f64)> {
        (self.count == 1.0).then(|| (self.terms[0], self.terms[4].sqrt()))
    }

    /// Replicates so far.
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// The measures; `None` for fewer than two replicates.
    pub fn performance(&self, known: KnownControl) -> Option<Performance> {
        let r = self.count;
        if r < 2.0 {
            return None;
        }
        let [error, square, _, fourth, of_variance, of_variance_squared, covered, r1, r2, s1, s2, c1, c2] =
            self.terms;
        let mean = error / r;
        let variance = ((square - r * mean * mean) / (r - 1.0)).max(0.0);
        let sd = variance.sqrt();
        let mse = square / r;
        let coverage = covered / r;
        let mean_variance = of_variance / r;
        let model_sd = mean_variance.sqrt();
        let variance_of_variance = spread([of_variance, of_variance_squared], r) * r;
        let (model_mcse, ratio, ratio_mcse) = if model_sd > 0.0 && sd > 0.0 {
            let model_mcse = (variance_of_variance / (4.0 * r * mean_variance)).sqrt();
            let ratio = model_sd / sd;
            let relative = variance_of_variance / (4.0 * r * mean_variance * mean_variance);
            (model_mcse, ratio - 1.0, ratio * (relative + 1.0 / (2.0 * (r - 1.0))).sqrt())
        } else {
            (0.0, 0.0, 0.0)
        };
        let is_controlled = self.controlled == r;
        let bias_controlled =
            is_controlled.then(|| Measured { value: r1 / r + known.mean, mcse: spread([r1, r2], r).sqrt() });
        let coverage_controlled = known
            .first_order_coverage
            .filter(|_| is_controlled)
            .map(|expected| Measured { value: expected + c1 / r, mcse: spread([c1, c2], r).sqrt() });
        let sd_controlled = bias_controlled.zip(known.first_order_variance).and_then(|(bias, known)| {
            let variance = known + s1 / r - bias.value * bias.value;
            let mcse = spread([s1, s2], r).sqrt();
            (variance > 0.0)
                .then(|| Measured { value: variance.sqrt(), mcse: mcse / (2.0 * variance.sqrt()) })
        });
        Some(Performance {
            bias: Measured { value: mean, mcse: sd / r.sqrt() },
            bias_controlled,
            sd: Measured { value: sd, mcse: sd / (2.0 * (r - 1.0)).sqrt() },
            sd_controlled,
            mse: Measured { value: mse, mcse: spread([square, fourth], r).sqrt() },
            coverage: Measured { value: coverage, mcse: (coverage * (1.0 - coverage) / r).sqrt() },
            coverage_controlled,
            model_sd: Measured { value: model_sd, mcse: model_mcse },
            model_sd_relative_error: Measured { value: ratio, mcse: ratio_mcse },
        })
    }
}

/// Squared standard error of a mean, from the sums of the values and of their squares.
fn spread(sums: [f64; 2], r: f64) -> f64 {
    let mean = sums[0] / r;
    ((sums[1] / r - mean * mean) / (r - 1.0)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Table 6 by its formulas, on the values themselves.
    fn by_definition(errors: &[f64], ses: &[f64]) -> [Measured; 4] {
        let r = errors.len() as f64;
        let mean = errors.iter().sum::<f64>() / r;
        let sd = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (r - 1.0)).sqrt();
        let mse = errors.iter().map(|e| e * e).sum::<f64>() / r;
        let mse_mcse = (errors.iter().map(|e| (e * e - mse).powi(2)).sum::<f64>() / (r * (r - 1.0))).sqrt();
        let covered =
            errors.iter().zip(ses).filter(|(e, s)| e.abs() <= 1.959963984540054 * **s).count() as f64 / r;
        let mod_var = ses.iter().map(|s| s * s).sum::<f64>() / r;
        let var_mod = ses.iter().map(|s| (s * s - mod_var).powi(2)).sum::<f64>() / (r - 1.0);
        let ratio = mod_var.sqrt() / sd;
        [
            Measured { value: mean, mcse: sd / r.sqrt() },
            Measured { value: mse, mcse: mse_mcse },
            Measured { value: covered, mcse: (covered * (1.0 - covered) / r).sqrt() },
            Measured {
                value: ratio - 1.0,
                mcse: ratio * (var_mod / (4.0 * r * mod_var * mod_var) + 1.0 / (2.0 * (r - 1.0))).sqrt(),
            },
        ]
    }

    proptest! {
        #[test]
        fn the_sums_give_table_6(errors in prop::collection::vec(-2.0..2.0_f64, 5..60), scale in 0.5..2.0_f64, cut in 1..4_usize) {
            let ses: Vec<f64> = errors.iter().enumerate().map(|(k, _)| scale * (1.0 + 0.1 * (k % 7) as f64)).collect();
            let mut parts = vec![ErrorSums::default(); cut + 1];
            for (k, (error, se)) in errors.iter().zip(&ses).enumerate() {
                let replicate = ReplicateError {
                    error: *error, se: *se, first_order: Some(0.5 * error), second_order: 0.4 * error, first_order_variance: Some(0.04),
                };
                parts[k % (cut + 1)].push(replicate);
            }
            let mut sums = ErrorSums::default();
            parts.iter().for_each(|part| sums.merge(part));
            let known = KnownControl { mean: 0.25, first_order_variance: None, first_order_coverage: Some(0.9) };
            let fast = sums.performance(known).expect("replicates enough");
            let slow = by_definition(&errors, &ses);
            for (fast, slow) in [fast.bias, fast.mse, fast.coverage, fast.model_sd_relative_error].iter().zip(slow) {
                prop_assert!((fast.value - slow.value).abs() < 1e-12, "{:?} {:?}", fast, slow);
                prop_assert!((fast.mcse - slow.mcse).abs() < 1e-9, "{:?} {:?}", fast, slow);
            }
            let controlled = fast.bias_controlled.expect("every replicate has a first-order part");
            prop_assert!((controlled.value - 0.25 - 0.1 * fast.bias.value).abs() < 1e-12);
            let within = errors.iter().filter(|e| (0.5 * **e).abs() <= 1.959963984540054 * 0.2).count() as f64 / errors.len() as f64;
            let controlled = fast.coverage_controlled.expect("its expectation is known");
            prop_assert!((controlled.value - 0.9 - (fast.coverage.value - within)).abs() < 1e-12);
        }
    }

    #[test]
    fn one_replicate_measures_nothing() {
        let mut sums = ErrorSums::default();
        let alone = ReplicateError {
            error: 1.0,
            se: 1.0,
            first_order: None,
            second_order: 0.0,
            first_order_variance: None,
        };
        sums.push(alone);
        assert_eq!(sums.performance(KnownControl::default()), None);
    }
}
