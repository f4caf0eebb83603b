//! The nominal model, with and without knots that follow refinements of the borders.

use crate::attribution::explain::Hypothesis;
use crate::nominal::knots::refinement;
use crate::records::dataset::Dataset;
use crate::settings::Settings;
use crate::simulation::simulate::free_run;

/// The nominal model.
#[derive(Debug)]
pub(super) struct Nominal {
    /// Without knots that follow refinements of the borders.
    pub(super) plain: Hypothesis,
    /// With border knots placed from the data; the same where refinements are no candidate.
    pub(super) detailed: Hypothesis,
}

impl Nominal {
    pub(super) fn new(dataset: &Dataset, settings: &Settings, detailed: Hypothesis) -> Self {
        let plain = coarse(dataset, &detailed);
        // Where refinements of the borders are no candidate, no other may take what knots that follow them gain.
        let follows = settings.consider_refinement();
        let detailed = if follows { detailed } else { plain.clone() };
        Self { plain, detailed }
    }

    /// Free runs over some records.
    pub(super) fn runs(&self, dataset: &Dataset, scaled_records: &[usize]) -> Vec<Vec<f64>> {
        scaled_records
            .iter()
            .map(|&k| free_run(dataset, &self.plain.fit, k, &dataset.scaled_records[k]))
            .collect()
    }
}

/// The model without the knots that follow refinements, where these matter; else the model itself.
fn coarse(dataset: &Dataset, detailed: &Hypothesis) -> Hypothesis {
    match detailed.on_a_smooth_grid(dataset) {
        Some(even) if even.bic() - detailed.bic() > refinement(dataset) => even,
        _ => detailed.clone(),
    }
}
