//! Simulations of the judged records and the noise in them.

use super::plan::Plan;
use crate::closure::Simulated;
use crate::likelihood::engine::Fit;
use crate::model::sensor::SensorCurve;
use crate::records::dataset::Criterion;
use crate::simulation::noise_response::NoiseResponse;
use crate::simulation::own_paths::without_own_paths;
use crate::simulation::simulate::free_run;
use switchback_model::spectrum::unpredictable_variance;

impl Plan {
    /// Variance of the noise in the output and its relative standard error.
    ///
    /// Repetition within periodic records needs no model; the augmented model's own floor is the other estimate. Effects
    /// that do not repeat with the input inflate the first, effects left out the second: the smaller one holds.
    pub(super) fn noise_floor(&self, fit: &Fit) -> (f64, f64) {
        if self.dataset.criterion.simulates() {
            return self.unforeseeable(fit);
        }
        let response = NoiseResponse::of(fit);
        let model = fit.power * response.gain() * self.noise_shown(&fit.augmented.curve);
        let relative = |n: f64| (2.0 / n).sqrt() * 2.0;
        // Rounding repeats with the input, and is noise all the same.
        let rounding = fit.augmented.noise.quantisation.map_or(0.0, |step| step * step / 12.0);
        match response.repeat_variance(&self.dataset, |_| true).map(|(repeat, n)| (repeat + rounding, n)) {
            Some((repeat, count)) if repeat < model => (repeat, relative(count as f64)),
            _ => (model, relative(fit.samples as f64)),
        }
    }

    /// Variance that the sensor's characteristic makes of one unit of it on the judged records: where it is steep it shows more of
    /// what lies before it.
    fn noise_shown(&self, curve: &SensorCurve) -> f64 {
        let scaled_records = self.judged.iter().map(|&number| &self.dataset.scaled_records[number]);
        curve.shown(scaled_records.flat_map(|scaled| &scaled.y[scaled.from..]).copied())
    }

    /// The part of the simulation error on the judged records that its own past does not predict: noise in the output is
    /// at most that.
    pub(super) fn unforeseeable(&self, fit: &Fit) -> (f64, f64) {
        let errors = self.judged_errors(fit);
        let count: usize = errors.iter().map(Vec::len).sum();
        (unpredictable_variance(&errors), (2.0 / count.max(1) as f64).sqrt() * 2.0)
    }

    /// Errors of the free run on the judged records. Where models are compared as simulators, what a record has of its own (the phase of a
    /// wave, the path of a zero) is taken out: it is unknown in a record that was not fitted, and no fault of the model.
    pub(super) fn judged_errors(&self, fit: &Fit) -> Vec<Vec<f64>> {
        let run = |number: usize| free_run(&self.dataset, fit, number, &self.dataset.scaled_records[number]);
        let errors = self.errors(run);
        match self.dataset.criterion.simulates() {
            true => without_own_paths(&self.dataset, fit, &self.judged, errors),
            false => errors,
        }
    }

    /// Variance of the innovations without the gap.
    pub(super) fn innovation_floor(&self, fit: &Fit) -> f64 {
        let power = match self.dataset.criterion {
            Criterion::OneStep => fit.power,
            Criterion::Simulation { .. } => self.unforeseeable(fit).0,
        };
        power.min(self.nominal.plain.fit.power).max(1e-300)
    }

    /// Every judged record simulated by the model under diagnosis and by another.
    pub(super) fn simulations(&self, fit: &Fit) -> Vec<Simulated> {
        self.judged
            .iter()
            .enumerate()
            .map(|(i, &number)| {
                let scaled = &self.dataset.scaled_records[number];
                let after = free_run(&self.dataset, fit, number, scaled);
                Simulated { number, before: self.runs[i].clone(), after }
            })
            .collect()
    }
}
