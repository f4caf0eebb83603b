//! The order of the linear part, where the rig does not declare it.

use crate::campaign::Campaign;
use crate::engine::Fit;
use crate::error::DiagnoseError;
use crate::given::stable;
use crate::nominal::identify;
use crate::simulate::free_run;

/// Identifies orders `1…most` and keeps the smallest that simulates the fit records within 3 % of the best one.
///
/// Equation-error criteria prefer high orders on real records, whose noise is never white; a simulation error that hardly falls
/// is no reason for another lag.
pub(crate) fn choose(campaign: &Campaign, most: usize) -> Result<Fit, DiagnoseError> {
    let mut tried = Vec::new();
    let mut failure = None;
    for n in 1..=most.max(1) {
        match identify(campaign, n) {
            Ok(fit) if stable(&fit.linear.a) => tried.push((simulation_error(campaign, &fit), fit)),
            Ok(_) => {}
            Err(e) => failure = failure.or(Some(e)),
        }
    }
    let least = tried.iter().map(|t| t.0).fold(f64::INFINITY, f64::min);
    tried.into_iter().find(|t| t.0 <= 1.03 * least).map(|t| t.1).ok_or_else(|| {
        failure.unwrap_or_else(|| DiagnoseError::Singular {
            reason: "every order tried gives an unstable model".into(),
        })
    })
}

fn simulation_error(campaign: &Campaign, fit: &Fit) -> f64 {
    let mut sum = 0.0;
    for (number, track) in campaign.tracks.iter().enumerate().filter(|(_, t)| t.is_fit()) {
        let y = free_run(campaign, fit, number, track);
        sum += y.iter().zip(&track.y).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
    }
    sum
}
