//! Whether the held-out records were taken under other conditions than the fit records.

use switchback_identify::statistics::{MeanInterval, Z95};
use switchback_model::rig::Usage;

use super::plan::Plan;
use crate::likelihood::engine::Fit;
use crate::residuals::score::innovations;

impl Plan {
    /// How many times as large, in root mean square, the errors of a model are on the held-out records as on those it was fitted to, where
    /// that is beyond the error of the mean (block bootstrap, 95 %) and the simulations of the held-out records miss more than the noise.
    ///
    /// A model that lacks nothing predicts other records of the same machine with `1 + k/N` times the variance, for `k` parameters and
    /// `N` samples that have `1 − k/N` of it left (H. Akaike, "Fitting autoregressive models for prediction", Ann. Inst. Stat. Math. 21,
    /// 1969).
    pub(super) fn held_out_errors_beyond_chance(&self, fit: &Fit) -> Option<f64> {
        // A held-out record too short to be judged says nothing of a machine either.
        let holds_out = self.judged.iter().all(|&number| !self.dataset.scaled_records[number].is_fit());
        if self.given.is_some() || !holds_out || self.resolves_no_gap(fit) {
            return None;
        }
        let share = fit.parameters / fit.samples.max(1) as f64;
        let expected = fit.power * (1.0 + share) / (1.0 - share).max(f64::MIN_POSITIVE);
        let errors = innovations(&self.dataset, fit, |scaled| scaled.usage == Usage::Holdout);
        let ratios: Vec<Vec<f64>> =
            errors.iter().map(|errors| errors.iter().map(|w| w * w / expected).collect()).collect();
        // What is expected is a variance of so many samples itself: its relative error is √(2/(N − k)).
        let freedom = (fit.samples as f64 - fit.parameters).max(1.0);
        let of_expected = Z95 * (2.0 / freedom).sqrt();
        let least =
            |ratio: &MeanInterval| ratio.mean - (ratio.mean - ratio.low).hypot(of_expected * ratio.mean);
        self.mean(&ratios, fit).filter(|ratio| least(ratio) > 1.0).map(|ratio| ratio.mean.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnose::degradation::tests::plan;

    #[test]
    fn the_same_machine_is_distinguished_from_one_with_another_gain_or_zero() {
        let mut plan = plan();
        let fit = plan.nominal.plain.fit.clone();
        assert_eq!(plan.held_out_errors_beyond_chance(&fit), None);
        let taken = plan.dataset.scaled_records[1].y.clone();
        for change in [|y: f64| 1.3 * y, |y: f64| y + 0.5, |y: f64| -y] {
            plan.dataset.scaled_records[1].y = taken.iter().map(|y| change(*y)).collect();
            let times = plan.held_out_errors_beyond_chance(&fit);
            assert!(times.is_some_and(|times| times > 1.5), "{times:?}");
        }
    }
}
