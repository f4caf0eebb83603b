//! Laws of the innovations other than one normal distribution.

use std::borrow::Cow;

use crate::likelihood::design::{Design, DesignScaled, Linear};
use crate::likelihood::input_noise_whitening::{Predictor, predictors};
use crate::model::augmented::{NoiseLaw, convolve};

/// What a law of the innovations makes of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Weights {
    /// Factor on each innovation that makes them equally distributed; absent where all are 1.
    pub(crate) scale: Option<Vec<Vec<f64>>>,
    /// Whitens the innovations and holds the factors, where noise on the input gives them a colour.
    pub(crate) predictors: Option<Vec<Predictor>>,
    /// Samples left out.
    pub(crate) left_out: usize,
    /// Sum of the factors' logarithms.
    pub(crate) log_scale: f64,
    /// The deviance itself, where it does not follow from the weighted sum of squares.
    pub(crate) deviance: Option<f64>,
    /// The mixture found.
    pub(crate) mixture: Option<(f64, f64)>,
}

impl Weights {
    /// Signals on the counted samples, weighted, all records one after the other.
    pub(crate) fn applied(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        self.by_scaled(signals).concat()
    }

    /// Signals on the counted samples, weighted.
    pub(crate) fn by_scaled<'a>(&self, signals: &'a [Vec<f64>]) -> Cow<'a, [Vec<f64>]> {
        if let Some(predictors) = &self.predictors {
            return signals.iter().zip(predictors).map(|(w, p)| p.applied(w)).collect();
        }
        let Some(scale) = &self.scale else { return Cow::Borrowed(signals) };
        let products = |(w, s): (&Vec<f64>, &Vec<f64>)| w.iter().zip(s).map(|(w, s)| w * s).collect();
        signals.iter().zip(scale).map(products).collect()
    }

    /// Weighs rows of derivatives of one record, one after the other.
    pub(crate) fn rows(&self, scaled: usize, width: usize) -> impl FnMut(&mut [f64]) + '_ {
        let mut follower = self.predictors.as_ref().map(|predictors| predictors[scaled].follow(width));
        let mut factors = self.scale.as_ref().map(|scale| scale[scaled].iter());
        move |row| match (&mut follower, &mut factors) {
            (Some(follower), _) => follower.next(row),
            (None, Some(factors)) => {
                let factor = factors.next().copied().unwrap_or_default();
                row.iter_mut().for_each(|x| *x *= factor);
            }
            (None, None) => {}
        }
    }

    /// Whether the counted sample has a say.
    pub(crate) fn counts(&self, scaled: usize, sample: usize) -> bool {
        self.scale.as_ref().is_none_or(|s| s[scaled][sample] > 0.0)
    }
}

/// Weighs the innovations by the law; masked samples are left out of it.
pub(crate) fn weigh(design: &Design, law: &NoiseLaw, p: &Linear, w: &[Vec<f64>]) -> Weights {
    if let Some(noise) = law.input {
        let response = impulse_response(&convolve(&p.b, &design.taps), &design.poles);
        let predictors = predictors(&design.scaled_records, noise, p, &response);
        let scale: Vec<Vec<f64>> = predictors.iter().map(|p| p.scale.clone()).collect();
        let left_out = scale.iter().flatten().filter(|s| **s == 0.0).count();
        let counted = sum_of_logarithms(scale.iter().flatten().copied().filter(|s| *s > 0.0));
        let log_scale = counted * stretch(&scale, left_out);
        let (scale, predictors) = (Some(scale), Some(predictors));
        return Weights { scale, predictors, left_out, log_scale, ..Weights::default() };
    }
    let masked: Option<Vec<Vec<bool>>> =
        (design.scaled_records.iter().any(|t| t.mask.out.is_some())).then(|| {
            let mask = |t: &DesignScaled| {
                t.mask.out.as_deref().map_or_else(|| vec![false; t.x.len() - t.from], <[bool]>::to_vec)
            };
            design.scaled_records.iter().map(mask).collect()
        });
    match (law.mixture, masked) {
        (Some(start), None) => mixture(start, law.least_variance(), w),
        (Some(start), Some(masked)) => mixture_of_the_rest(start, law.least_variance(), w, &masked),
        (None, None) => Weights::default(),
        (None, Some(masked)) => {
            let mut scale: Vec<Vec<f64>> = w.iter().map(|w| vec![1.0; w.len()]).collect();
            let left_out = leave_out(&mut scale, &masked);
            Weights { scale: Some(scale), left_out, ..Weights::default() }
        }
    }
}

/// `Σ ln x` of positive numbers: few logarithms of long products.
fn sum_of_logarithms(values: impl Iterator<Item = f64>) -> f64 {
    // The product of two such numbers is far from the ends of the range.
    const SAFE: std::ops::Range<f64> = 1e-150..1e150;
    let (mut sum, mut product) = (0.0, 1.0_f64);
    for x in values {
        if !SAFE.contains(&x) {
            sum += x.ln();
            continue;
        }
        product *= x;
        if !SAFE.contains(&product) {
            sum += product.ln();
            product = 1.0;
        }
    }
    sum + product.ln()
}

/// What is left out counts as much as the rest does in the mean, so that nothing is gained by leaving out.
fn stretch(scale: &[Vec<f64>], left_out: usize) -> f64 {
    let all = scale.iter().map(Vec::len).sum::<usize>();
    all as f64 / all.saturating_sub(left_out).max(1) as f64
}

/// Takes the weight from masked samples; their number.
fn leave_out(scale: &mut [Vec<f64>], masked: &[Vec<bool>]) -> usize {
    let mut left_out = 0;
    for (scale, _) in (scale.iter_mut().flatten().zip(masked.iter().flatten())).filter(|(_, c)| **c) {
        *scale = 0.0;
        left_out += 1;
    }
    left_out
}

/// The mixture of the samples that are not masked; where all are, no law explains anything, and the deviance is infinite.
fn mixture_of_the_rest(start: (f64, f64), least: f64, w: &[Vec<f64>], masked: &[Vec<bool>]) -> Weights {
    let counted = |(w, masked): (&Vec<f64>, &Vec<bool>)| {
        w.iter().zip(masked).filter(|(_, c)| !**c).map(|(w, _)| *w).collect::<Vec<f64>>()
    };
    let rest: Vec<Vec<f64>> = w.iter().zip(masked).map(counted).collect();
    let mut weights = match rest.iter().all(Vec::is_empty) {
        true => Weights { deviance: Some(f64::INFINITY), ..Weights::default() },
        false => mixture(start, least, &rest),
    };
    let mut found = weights.scale.iter().flatten().flatten().copied();
    let mut left_out = 0;
    let scale = masked.iter().map(|scaled| {
        let one = |c: &bool| if *c { 0.0 } else { found.next().unwrap_or(1.0) };
        left_out += scaled.iter().filter(|c| **c).count();
        scaled.iter().map(one).collect()
    });
    let scale: Vec<Vec<f64>> = scale.collect();
    weights.deviance = weights.deviance.map(|d| d * stretch(&scale, left_out));
    (weights.scale, weights.left_out) = (Some(scale), left_out);
    weights
}

/// The impulse response of `b/(1 + poles)`, as far as it matters.
pub(crate) fn impulse_response(b: &[f64], poles: &[f64]) -> Vec<f64> {
    const LONGEST: usize = 200;
    const NEGLIGIBLE: f64 = 1e-3;
    let length = if poles.is_empty() { b.len() } else { LONGEST };
    let mut h = vec![0.0; length];
    for t in 0..length {
        let past: f64 = poles.iter().enumerate().take(t).map(|(k, p)| p * h[t - k - 1]).sum();
        h[t] = b.get(t).copied().unwrap_or(0.0) - past;
    }
    let energy: f64 = h.iter().map(|h| h * h).sum();
    let mut tail = 0.0;
    while h.len() > b.len() {
        tail += h[h.len() - 1].powi(2);
        if tail > NEGLIGIBLE * energy {
            break;
        }
        h.pop();
    }
    h
}

/// The exponential of this is less than any density that counts.
const LEAST_EXPONENT: f64 = -700.0;

/// `w ~ (1−ε)·N(0,σ²) + ε·N(0,κ²σ²)` with `σ²` of `least` or more, fitted by expectation–maximisation.
pub(crate) fn mixture((mut share, mut ratio): (f64, f64), least: f64, w: &[Vec<f64>]) -> Weights {
    let all: Vec<f64> = w.iter().flatten().copied().collect();
    let n = all.len() as f64;
    let mut magnitudes: Vec<f64> = all.iter().map(|x| x.abs()).collect();
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    let mut variance = (*median / 0.6745).powi(2).max(least);
    let squares: Vec<f64> = all.iter().map(|x| x * x).collect();
    let mut wide = vec![0.0; all.len()];
    let mut deviance = 0.0;
    for _ in 0..25 {
        let (mut count, mut narrow_sum, mut wide_sum) = (0.0, 0.0, 0.0);
        let before = deviance;
        let wide_variance = ratio * ratio * variance;
        let (narrow_rate, broad_rate) = (-0.5 / variance, -0.5 / wide_variance);
        let (narrow_top, broad_top) = ((1.0 - share) / variance.sqrt(), share / wide_variance.sqrt());
        let densities = squares.iter().zip(&mut wide).map(|(square, tau)| {
            // Below the floor the exponential is nothing, and slow.
            let broad = broad_top * (broad_rate * square).max(LEAST_EXPONENT).exp();
            let narrow = narrow_top * (narrow_rate * square).max(LEAST_EXPONENT).exp();
            let both = (narrow + broad).max(1e-300);
            *tau = broad / both;
            count += *tau;
            narrow_sum += (1.0 - *tau) * square;
            wide_sum += *tau * square;
            both
        });
        deviance = -2.0 * sum_of_logarithms(densities);
        share = (count / n).clamp(1e-5, 0.3);
        variance = (narrow_sum / (n - count).max(1.0)).max(least);
        ratio = (wide_sum / count.max(1e-9) / variance).sqrt().clamp(2.5, 1e3);
        if (deviance - before).abs() < 1e-3 {
            break;
        }
    }
    let mut rest = wide.iter();
    let scale = w
        .iter()
        .map(|w| {
            rest.by_ref().take(w.len()).map(|tau| ((1.0 - tau) + tau / (ratio * ratio)).sqrt()).collect()
        })
        .collect();
    // The concentrated normal deviance drops N(1 + ln 2π); the densities above already lack the √2π.
    Weights {
        scale: Some(scale),
        deviance: Some(deviance - n),
        mixture: Some((share, ratio)),
        ..Weights::default()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::model::augmented::LEAST_VARIANCE;

    proptest! {
        #[test]
        fn logarithms_add_up(exponents in prop::collection::vec(-300.0..300.0_f64, 0..50)) {
            let values = exponents.iter().map(|e| 10f64.powf(*e));
            let slow: f64 = values.clone().map(f64::ln).sum();
            prop_assert!((sum_of_logarithms(values) - slow).abs() < 1e-9);
        }
    }

    #[test]
    fn the_response_of_a_lag_is_geometric() {
        let h = impulse_response(&[0.5], &[-0.5]);
        assert!(
            h.len() < 8 && h.iter().enumerate().all(|(k, h)| (h - 0.5f64.powi(k as i32 + 1)).abs() < 1e-15)
        );
        assert_eq!(impulse_response(&[0.3, 0.1], &[]), [0.3, 0.1]);
    }

    #[test]
    fn a_mixture_of_nothing_explains_nothing() {
        let w = [vec![0.3, -0.2], vec![0.1]];
        let of = |masked: &[Vec<bool>]| mixture_of_the_rest((0.05, 8.0), LEAST_VARIANCE, &w, masked);
        let nothing = of(&[vec![true, true], vec![true]]);
        assert_eq!((nothing.deviance, nothing.left_out), (Some(f64::INFINITY), 3));
        assert!(of(&[vec![true, false], vec![true]]).deviance.is_some_and(f64::is_finite));
    }

    #[test]
    fn values_that_repeat_are_worth_no_more_than_the_least_variance_allows() {
        // A sensor at rest: nothing but zeros, and a step now and then.
        let w = vec![(0..1000).map(|k| f64::from(u8::from(k % 100 == 0))).collect::<Vec<f64>>()];
        let deviance = |least: f64| mixture((0.01, 8.0), least, &w).deviance.expect("a mixture");
        assert!(deviance(LEAST_VARIANCE) < -10_000.0);
        let normal = 1000.0 * 0.01_f64.ln();
        assert!(deviance(1.0 / 12.0) > normal, "{} {normal}", deviance(1.0 / 12.0));
    }

    #[test]
    fn masked_samples_have_no_say_in_a_mixture() {
        let w = vec![
            (0..400)
                .map(|k| f64::from(k % 7) - 3.0 + if k % 50 == 0 { 40.0 } else { 0.0 })
                .collect::<Vec<f64>>(),
        ];
        let alone = mixture((0.01, 8.0), LEAST_VARIANCE, &w);
        let mut longer = w.clone();
        let mut masked = vec![vec![false; 400]];
        longer[0].insert(17, 1e6);
        masked[0].insert(17, true);
        let rest = mixture_of_the_rest((0.01, 8.0), LEAST_VARIANCE, &longer, &masked);
        let stretched = alone.deviance.map(|d| d * (401.0 / 400.0));
        assert_eq!((rest.deviance, rest.mixture, rest.left_out), (stretched, alone.mixture, 1));
        let scale = &rest.scale.as_ref().expect("weights")[0];
        assert!(scale[17] == 0.0 && scale[18] == alone.scale.as_ref().expect("weights")[0][17]);
    }
}
