//! From a fit to a model that can be taken along.

use switchback_model::rig::Rig;

use super::place::{Known, print};
use super::portable::{Moved, PortableModel, Scales, Wire};
use crate::attribution::explain::{Explanation, assembled};
use crate::likelihood::engine::{Fit, Ground};
use crate::likelihood::uncertainty::{Uncertainty, uncertainty};
use crate::records::campaign::Campaign;
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

    /// An explanation with the covariance of all that it estimates.
    pub(crate) fn fitted(&self, campaign: &Campaign, explanation: &Explanation) -> PortableModel {
        let fit = &explanation.fit;
        let ground = Ground { campaign, grid: &fit.grid, known: Some(fit.near()) };
        let known = uncertainty(ground, &|values| assembled(&explanation.parts, values), fit);
        self.model(campaign, fit, known)
    }

    /// A model that was given: nothing of it was estimated.
    pub(crate) fn given(&self, campaign: &Campaign, fit: &Fit) -> PortableModel {
        self.model(campaign, fit, None)
    }

    fn model(&self, campaign: &Campaign, fit: &Fit, known: Option<Uncertainty>) -> PortableModel {
        // Errors of simulation are those of the output already.
        let gain = if campaign.criterion.simulates() { 1.0 } else { NoiseResponse::of(fit).gain() };
        let (covariance, moved) = match known {
            Some(known) => (Some(lower(known.covariance)), known.moved),
            None => (None, Vec::new()),
        };
        PortableModel(Wire {
            scales: Scales {
                v_low: campaign.v_low,
                v_width: campaign.v_width,
                y_mean: campaign.y_mean,
                y_scale: campaign.y_scale,
            },
            lead: campaign.lead,
            rule: campaign.rule,
            criterion: campaign.criterion,
            clock: Known::of(campaign, &self.prints),
            grid: fit.grid.clone(),
            assembly: fit.assembly.clone(),
            linear: fit.linear.padded(fit.grid.len(), &fit.assembly),
            variance: fit.variance,
            output_noise: fit.power * gain,
            covariance,
            moved: moved.into_iter().map(|(step, assembly)| Moved { step, assembly }).collect(),
        })
    }
}

/// The rows of the lower triangle.
fn lower(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    rows.iter_mut().enumerate().for_each(|(i, row)| row.truncate(i + 1));
    rows
}
