//! From a fit to a model that can be taken along.

use switchback_model::rig::Rig;

use super::place::{Known, print};
use super::portable::{Moved, PortableModel, Scales, Wire};
use crate::attribution::explain::{Hypothesis, assembled};
use crate::likelihood::engine::{Fit, FitContext};
use crate::likelihood::uncertainty::{Uncertainty, uncertainty};
use crate::records::dataset::Dataset;
use crate::simulation::noise_response::NoiseResponse;

/// Makes models of the fits to one rig.
#[derive(Debug)]
pub(crate) struct Exporter {
    /// What each record is known by.
    pub(super) prints: Vec<String>,
}

impl Exporter {
    pub(crate) fn new(rig: &Rig) -> Self {
        Self { prints: rig.records.iter().map(|r| print(r.record.v(), r.record.y())).collect() }
    }

    /// A candidate with the covariance of all that it estimates.
    pub(crate) fn fitted(&self, dataset: &Dataset, hypothesis: &Hypothesis) -> PortableModel {
        let fit = &hypothesis.fit;
        let context = FitContext { dataset, grid: &fit.grid, known: Some(fit.near()) };
        let known = uncertainty(context, &|values| assembled(&hypothesis.effect_terms, values), fit);
        self.model(dataset, fit, known)
    }

    /// A model that was given: nothing of it was estimated.
    pub(crate) fn given(&self, dataset: &Dataset, fit: &Fit) -> PortableModel {
        self.model(dataset, fit, None)
    }

    fn model(&self, dataset: &Dataset, fit: &Fit, known: Option<Uncertainty>) -> PortableModel {
        // Errors of simulation are those of the output already.
        let gain = if dataset.criterion.simulates() { 1.0 } else { NoiseResponse::of(fit).gain() };
        let (covariance, moved) = match known {
            Some(known) => (Some(lower(known.covariance)), known.moved),
            None => (None, Vec::new()),
        };
        PortableModel(Wire {
            scales: Scales {
                v_low: dataset.v_low,
                v_width: dataset.v_width,
                y_mean: dataset.y_mean,
                y_scale: dataset.y_scale,
            },
            lead: dataset.lead,
            rule: dataset.rule,
            criterion: dataset.criterion,
            clock: Known::of(dataset, &self.prints),
            grid: fit.grid.clone(),
            augmented: fit.augmented.clone(),
            linear: fit.linear.padded(fit.grid.len(), &fit.augmented),
            variance: fit.variance,
            output_noise: fit.power * gain,
            covariance,
            moved: moved.into_iter().map(|(step, augmented)| Moved { step, augmented }).collect(),
        })
    }
}

/// The rows of the lower triangle.
fn lower(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    rows.iter_mut().enumerate().for_each(|(i, row)| row.truncate(i + 1));
    rows
}
