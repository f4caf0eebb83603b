//! What the noise of a model makes of the output.

use crate::likelihood::engine::Fit;
use crate::records::dataset::{Dataset, ScaledRecord};

/// Noise in the output under a model: the response of `C/(A·D)` to one innovation.
pub(crate) struct NoiseResponse(Vec<f64>);

impl NoiseResponse {
    /// Samples of the response at most.
    const LONGEST: usize = 4000;
    /// Correlation from which a lag no longer shows the variance.
    const TOO_MUCH: f64 = 0.95;

    /// The response under a fitted noise law.
    pub(crate) fn of(fit: &Fit) -> Self {
        let law = &fit.augmented.noise;
        let poles = crate::model::augmented::times_monic(&fit.linear.a, &law.ar);
        let zeros = if law.output_ratio > 0.0 {
            crate::likelihood::spectral::factor_of_sum(law.output_ratio, &fit.linear.a)
        } else {
            law.ma.clone()
        };
        let mut h: Vec<f64> = Vec::with_capacity(Self::LONGEST);
        let mut sum = 0.0;
        for t in 0..Self::LONGEST {
            let mut now = if t == 0 { 1.0 } else { zeros.get(t - 1).copied().unwrap_or(0.0) };
            for (i, a) in poles.iter().enumerate() {
                if t > i {
                    now -= a * h[t - i - 1];
                }
            }
            sum += now * now;
            h.push(now);
            if sum > 1e9 || (t > 50 && h[t - 20..].iter().all(|x| x.abs() < 1e-9)) {
                break;
            }
        }
        Self(h)
    }

    /// Output variance that one unit of innovation variance makes: `Σ h²`.
    pub(crate) fn gain(&self) -> f64 {
        self.0.iter().map(|h| h * h).sum()
    }

    /// Share of the output's noise variance that half the squared difference of two samples `lag` apart shows: slow noise
    /// is common to both.
    fn shown_by_differences(&self, lag: usize) -> f64 {
        let common: f64 = self.0.iter().zip(self.0.iter().skip(lag)).map(|(x, y)| x * y).sum();
        1.0 - (common / self.gain()).min(Self::TOO_MUCH)
    }

    /// Variance of the output about its mean over periods, pooled over the periodic records; drift slower than a few
    /// periods is taken out by differencing neighbouring periods. Absent without periodic records.
    pub(crate) fn repeat_variance(
        &self,
        dataset: &Dataset,
        counted: impl Fn(&ScaledRecord) -> bool,
    ) -> Option<(f64, usize)> {
        let (mut sum, mut count) = (0.0, 0);
        for scaled in dataset.scaled_records.iter().filter(|t| counted(t)) {
            let Some(period) = scaled.period else { continue };
            let start = (scaled.from + period).max(2 * period).min(scaled.y.len());
            let squares = (start..scaled.y.len()).map(|t| (scaled.y[t] - scaled.y[t - period]).powi(2));
            sum += 0.5 * squares.sum::<f64>() / self.shown_by_differences(period);
            count += scaled.y.len() - start;
        }
        (count > 200).then(|| (sum / count as f64, count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_of_slow_noise_show_what_two_samples_do_not_share() {
        // First-order noise with pole p: variance 1/(1 − p²), correlation p^lag.
        let p = 0.98_f64;
        let response = NoiseResponse((0..2000).map(|t| p.powi(t)).collect());
        assert!((response.gain() - 1.0 / (1.0 - p * p)).abs() < 1e-9);
        for lag in [1, 10, 100] {
            let shown = (1.0 - p.powi(lag)).max(1.0 - NoiseResponse::TOO_MUCH);
            assert!((response.shown_by_differences(lag as usize) - shown).abs() < 1e-9);
        }
        assert!((response.shown_by_differences(5000) - 1.0).abs() < 1e-12);
    }
}
