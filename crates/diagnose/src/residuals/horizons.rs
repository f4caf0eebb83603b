//! How far ahead a model predicts the fitted records better than another does.
//!
//! ```text
//! one step       w, the innovations of the best autoregression of the equation errors e: neither model gains by the colour of its errors
//! h samples      r(t) = e(t) − Σ aᵢ r(t−i), begun anew at the measured output every h samples
//! free run       the same, begun once in each record
//! gain           Σ (r₀² − r₁²)/Σ r₀²,   its error that of the mean of r₀² − r₁² by a block bootstrap
//! ```
//!
//! Noise that is coloured is predicted better one step ahead, and nothing else; a cause that moves the simulation gains at long horizons. No
//! variance rests on a likelihood, which would hold the model for true: both models may be wrong (Q. H. Vuong, Econometrica 57, 1989; F. X.
//! Diebold and R. S. Mariano, J. Business & Economic Statistics 13, 1995).

use std::sync::Arc;

use switchback_identify::statistics::{MeanInterval, Z95};

use crate::horizon::{Horizon, HorizonGain};
use crate::likelihood::design::Design;
use crate::likelihood::engine::Fit;
use crate::likelihood::whitener::LEAD;
use crate::simulation::simulate::sensed;
use switchback_model::spectrum::{autoregression, independent_share, mean_square};

/// Longest autoregression of the equation errors: that of the longest law of coloured noise.
const MEMORY: usize = 20;

/// A model at all horizons, ready to be compared with others on the same samples.
pub(crate) struct Reference {
    horizons: Vec<(Horizon, Predicted)>,
    /// Samples for which errors hang together at least.
    memory: usize,
}

impl Reference {
    /// The fitted records as a model predicts them: one step ahead, until it has settled, midway between on a scale of ratios, and all
    /// of each record.
    pub(crate) fn of(fit: &Fit) -> Self {
        let settling = fit.linear.settling();
        let halfway = (settling as f64).sqrt().round() as usize;
        let errors = Errors::of(fit);
        let longest =
            errors.design.scaled_records.iter().map(|t| t.x.len() - t.from).max().unwrap_or_default();
        let between = [halfway, settling].into_iter().filter(|h| (2..longest).contains(h));
        let all = [Horizon::Step].into_iter().chain(between.map(Horizon::Samples)).chain([Horizon::FreeRun]);
        Self { horizons: all.map(|horizon| (horizon, errors.at(horizon))).collect(), memory: settling }
    }

    /// What another model gains.
    pub(crate) fn gains(&self, fit: &Fit) -> Vec<HorizonGain> {
        let errors = Errors::of(fit);
        let gained = |(horizon, before): &(Horizon, Predicted)| {
            let (share, certainty) = before.gained_by(&errors.at(*horizon), self.memory)?;
            Some(HorizonGain { horizon: *horizon, share, certainty })
        };
        self.horizons.iter().filter_map(gained).collect()
    }
}

/// Prediction errors of a model at a horizon.
struct Predicted {
    /// A record at a time, from the first counted sample.
    errors: Vec<Vec<f64>>,
    /// As how many independent errors they count.
    independent: f64,
    parameters: f64,
}

impl Predicted {
    /// Share of the mean square error that another model saves on the same samples, and the same in units of its standard error; nothing where
    /// either has errors that are no numbers, or more parameters than independent errors.
    ///
    /// The mean square error of a model of `k` parameters, fitted to `n` independent errors, is raised to what it would be elsewhere, by
    /// `(1 + k/n)/(1 − k/n)` (H. Akaike, "Fitting autoregressive models for prediction", Ann. Inst. Stat. Math. 21, 1969).
    fn gained_by(&self, other: &Self, memory: usize) -> Option<(f64, f64)> {
        let n = self.independent;
        let elsewhere = |k: f64| (k < n).then(|| (1.0 + k / n) / (1.0 - k / n));
        let cost = elsewhere(other.parameters)? / elsewhere(self.parameters)?;
        let saved_in = |(before, after): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
            before.iter().zip(after).map(|(x, y)| x * x - cost * y * y).collect()
        };
        let saved: Vec<Vec<f64>> = self.errors.iter().zip(&other.errors).map(saved_in).collect();
        let series: Vec<&[f64]> = saved.iter().map(Vec::as_slice).collect();
        let mean = MeanInterval::of_remembering(&series, memory)?;
        let error = (mean.high - mean.low) / (2.0 * Z95);
        let certainty = if mean.mean == 0.0 { 0.0 } else { mean.mean / error.max(f64::MIN_POSITIVE) };
        Some((mean.mean / mean_square(&self.errors).max(f64::MIN_POSITIVE), certainty))
    }
}

/// Equation errors of a fit on the fitted records, once for all horizons.
struct Errors<'a> {
    fit: &'a Fit,
    /// From [`LEAD`] samples before the first counted one.
    equation: Vec<Vec<f64>>,
    /// Samples of each before the first counted one.
    lead: Vec<usize>,
    design: Arc<Design>,
}

impl<'a> Errors<'a> {
    fn of(fit: &'a Fit) -> Self {
        let design = fit.design();
        let lead = design.scaled_records.iter().map(|t| t.from.min(LEAD)).collect();
        Self { fit, equation: design.all_errors(&fit.linear), lead, design }
    }

    /// The prediction errors of the readings at a horizon.
    fn at(&self, horizon: Horizon) -> Predicted {
        let mut errors = match horizon {
            Horizon::Step => self.innovations(),
            Horizon::Samples(h) => self.begun_every(h.max(1)),
            Horizon::FreeRun => self.begun_every(usize::MAX),
        };
        let augmented = &self.fit.augmented;
        if !augmented.curve.is_straight() || augmented.saturation.is_some() {
            let read = |x: f64| sensed(augmented, x);
            for (errors, scaled) in errors.iter_mut().zip(&self.design.scaled_records) {
                let measured = &scaled.x[scaled.from..];
                errors.iter_mut().zip(measured).for_each(|(e, x)| *e = read(*x) - read(x - *e));
            }
        }
        let count = errors.iter().map(Vec::len).sum::<usize>() as f64;
        let independent = count * independent_share(&errors);
        Predicted { errors, independent, parameters: self.fit.parameters }
    }

    fn innovations(&self) -> Vec<Vec<f64>> {
        let counted: Vec<Vec<f64>> = self.counted().collect();
        let colour = autoregression(&counted, MEMORY);
        let of_record = |(e, lead): (&Vec<f64>, &usize)| {
            let past = |t: usize| colour.iter().enumerate().take(t).map(move |(i, d)| d * e[t - 1 - i]);
            (*lead..e.len()).map(|t| e[t] + past(t).sum::<f64>()).collect()
        };
        self.equation.iter().zip(&self.lead).map(of_record).collect()
    }

    fn counted(&self) -> impl Iterator<Item = Vec<f64>> {
        self.equation.iter().zip(&self.lead).map(|(e, lead)| e[*lead..].to_vec())
    }

    fn begun_every(&self, h: usize) -> Vec<Vec<f64>> {
        let of_record = |e: Vec<f64>| {
            let mut r: Vec<f64> = Vec::with_capacity(e.len());
            for (t, e) in e.iter().enumerate() {
                let since = t % h;
                let past = self.fit.linear.a.iter().enumerate().take(since).map(|(i, a)| a * r[t - 1 - i]);
                r.push(e - past.sum::<f64>());
            }
            r
        };
        self.counted().map(of_record).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::model::augmented::AugmentedModel;
    use crate::model::linear::Linear;
    use crate::records::dataset::Dataset;
    use crate::testing::{noise_free, small_dataset, small_model, white};

    /// A dataset whose equation errors have the autoregression `1 + d q⁻¹`, a fit of it, and the truth.
    fn measured(d: f64) -> (Dataset, Fit) {
        let (dataset, grid) = small_dataset();
        let truth = small_model(&grid);
        let mut dataset = noise_free(dataset, &grid, &AugmentedModel::default(), &truth);
        let mut noise = white();
        for scaled in &mut dataset.scaled_records {
            let (mut error, mut past) = (0.0, [0.0; 2]);
            for y in &mut scaled.y {
                error = 0.02 * noise() - d * error;
                let now = error - truth.a[0] * past[0] - truth.a[1] * past[1];
                past = [now, past[0]];
                *y += now;
            }
        }
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        let mut augmented = AugmentedModel::default();
        augmented.noise.ar = vec![d];
        let fit = fit(context, &|_| augmented.clone(), &[], &truth, 20).expect("a fit");
        (dataset, fit)
    }

    /// The oracle: every segment simulated from the measured outputs before it.
    #[test]
    fn predictions_are_simulations_from_the_measured_outputs() {
        let (_, fit) = measured(0.0);
        let Linear { a, b, f, .. } = &fit.linear;
        let errors = Errors::of(&fit);
        for h in [1, 7, usize::MAX] {
            let found = errors.at(Horizon::Samples(h)).errors;
            let design = fit.design();
            for (scaled, found) in design.scaled_records.iter().zip(found) {
                let u = design.input(scaled, f);
                let mut run = scaled.x.to_vec();
                for t in scaled.from..scaled.x.len() {
                    let begun = scaled.from + (t - scaled.from) / h * h;
                    let past = |lag: usize| if t - lag < begun { scaled.x[t - lag] } else { run[t - lag] };
                    let a: f64 = a.iter().enumerate().map(|(i, a)| a * past(i + 1)).sum();
                    run[t] = b.iter().enumerate().map(|(j, b)| b * u[t - j - 1]).sum::<f64>() - a;
                    assert!((scaled.x[t] - run[t] - found[t - scaled.from]).abs() < 1e-9, "{h} {t}");
                }
            }
        }
    }

    #[test]
    fn a_cause_gains_at_long_horizons_and_the_colour_of_noise_at_none() {
        let (_, good) = measured(0.6);
        let gains = |fit: &Fit| Reference::of(fit).gains(&good);
        // Knowing the colour: the other one is given it.
        let mut white = good.clone();
        white.augmented.noise.ar.clear();
        for gain in gains(&white) {
            assert!(gain.share.abs() < 1e-9 && gain.certainty.abs() < 1e-9, "{gain:?}");
        }
        // A loop that is too small.
        let mut small = good.clone();
        small.linear.f.iter_mut().for_each(|f| *f *= 0.8);
        let by = gains(&small);
        assert_eq!(by.first().map(|g| g.horizon), Some(Horizon::Step));
        assert!(
            by.last().is_some_and(|g| g.horizon == Horizon::FreeRun && g.share > 0.5 && g.certainty > 3.0)
        );
        assert!(by.windows(2).all(|pair| pair[0].share < pair[1].share), "{by:?}");
        // What is worse says so.
        let worse = Reference::of(&good).gains(&small);
        assert!(worse.iter().all(|g| g.share < 0.0 && g.certainty < 0.0), "{worse:?}");
    }

    /// The oracle: a coefficient that means nothing, fitted to `n` white errors, gains `σ²/n` where it was fitted.
    #[test]
    fn parameters_that_mean_nothing_gain_nothing_on_average() {
        let mut noise = crate::testing::white();
        let (n, draws) = (300, 400);
        let mut sum = 0.0;
        for _ in 0..draws {
            let errors: Vec<f64> = (0..n).map(|_| noise()).collect();
            let shape: Vec<f64> = (0..n).map(|_| noise()).collect();
            let energy: f64 = shape.iter().map(|x| x * x).sum();
            let d = errors.iter().zip(&shape).map(|(e, x)| e * x).sum::<f64>() / energy;
            let after = errors.iter().zip(&shape).map(|(e, x)| e - d * x).collect();
            let predicted = |errors: Vec<f64>, parameters| Predicted {
                errors: vec![errors],
                independent: f64::from(n),
                parameters,
            };
            let (share, _) = predicted(errors, 0.0).gained_by(&predicted(after, 1.0), 1).expect("numbers");
            sum += share;
        }
        // Elsewhere it costs as much as it gains here.
        let expected = -1.0 / f64::from(n);
        assert!((sum / f64::from(draws) - expected).abs() < 0.5 / f64::from(n), "{}", sum / f64::from(draws));
    }
}
