//! The nominal model, with and without knots that follow details of the borders.

use crate::attribution::explain::Explanation;
use crate::nominal::knots::detail;
use crate::records::campaign::Campaign;
use crate::settings::Settings;
use crate::simulation::simulate::free_run;

/// The nominal model.
#[derive(Debug)]
pub(super) struct Nominal {
    /// Without knots that follow details of the borders.
    pub(super) plain: Explanation,
    /// With border knots placed from the data; the same where details are no candidate.
    pub(super) detailed: Explanation,
}

impl Nominal {
    pub(super) fn new(campaign: &Campaign, settings: &Settings, detailed: Explanation) -> Self {
        let plain = coarse(campaign, &detailed);
        // Where details of the borders are no candidate, no other may take what knots that follow them gain.
        let follows = settings.consider_details();
        let detailed = if follows { detailed } else { plain.clone() };
        Self { plain, detailed }
    }

    /// Free runs over some tracks.
    pub(super) fn runs(&self, campaign: &Campaign, tracks: &[usize]) -> Vec<Vec<f64>> {
        tracks.iter().map(|&k| free_run(campaign, &self.plain.fit, k, &campaign.tracks[k])).collect()
    }
}

/// The model without the knots that follow details, where these matter; else the model itself.
fn coarse(campaign: &Campaign, detailed: &Explanation) -> Explanation {
    match detailed.on_a_smooth_grid(campaign) {
        Some(even) if even.bic() - detailed.bic() > detail(campaign) => even,
        _ => detailed.clone(),
    }
}
