//! A model that misses nothing worth a cause.

use super::plan::Plan;
use super::report::Conclusion;
use crate::verdict::answer::Status;
use crate::verdict::answer::naming_nothing;
use crate::verdict::odds::Odds;
use switchback_model::spectrum::mean_square;

/// Mean square error over the output's variance up to which a model is exact: a thousandth of the spread in root mean square, about what a
/// converter of ten bits rounds away (`range/1024/√12`, with a range of three spreads or so).
const EXACT: f64 = 1e-6;

impl Plan {
    /// The conclusion that nothing is missing, where the simulations of the judged records and the predictions of the fit records are exact.
    ///
    /// In records without noise the remaining error is rounding, and the curvature of borders between knots. Likelihoods would find an effect in
    /// such errors, however small.
    pub(super) fn nothing_to_explain(&self) -> Option<Conclusion> {
        let plain = &self.nominal.plain;
        let missed = mean_square(&self.errors(|number| self.run_before(number)));
        let spread = self.judged_variance();
        let is_exact = missed <= EXACT * spread && plain.fit.power <= EXACT;
        is_exact.then(|| Conclusion {
            fitted: Vec::new(),
            singles: Vec::new(),
            odds: Odds::of_nothing(),
            verdict: naming_nothing(Status::None, None, Odds::of_nothing().none),
            augmented: plain.clone(),
            left: 0.0,
            together: None,
            other: None,
        })
    }

    /// Variance of the output on the judged records, each about its mean.
    fn judged_variance(&self) -> f64 {
        let about_its_mean = |&number: &usize| {
            let scaled = &self.dataset.scaled_records[number];
            let y = &scaled.y[scaled.from..];
            let mean = y.iter().sum::<f64>() / y.len().max(1) as f64;
            y.iter().map(|y| y - mean).collect()
        };
        mean_square(&self.judged.iter().map(about_its_mean).collect::<Vec<Vec<f64>>>())
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnose::degradation::tests::plan;

    #[test]
    fn rounding_is_no_gap_and_what_a_sensor_sees_is_one() {
        let mut plan = plan();
        assert!(plan.nothing_to_explain().is_none(), "the records have noise");
        plan.nominal.plain.fit.power = 1e-7;
        assert!(plan.nothing_to_explain().is_none(), "the held-out record has noise");
        let run = plan.run_before(1);
        plan.dataset.scaled_records[1].y = run.iter().map(|y| y + 1e-4).collect();
        assert!(plan.nothing_to_explain().is_some());
        plan.dataset.scaled_records[1].y = run.iter().map(|y| y + 1e-2).collect();
        assert!(plan.nothing_to_explain().is_none());
    }
}
