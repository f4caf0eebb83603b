//! The reversal rules worth trying on an input.

use super::settings::Settings;
use switchback_model::reversal::{ReversalRule, SensorNoise, Timing};

/// A lower threshold that the fit may prefer: one false reversal in some hundred samples at rest, but loops of half the size seen.
const LOW_THRESHOLD_IN_SD: f64 = 3.5;

/// The rules worth trying, simplest first; a threshold or timing that the settings give is kept.
///
/// On a noisy input the extremum of a rest is anywhere in it, and three noise sds is the band that holds nearly all of it.
/// Beside the safe threshold a lower one is tried, since real loops may be small. A causal model has no choice but to switch
/// at the sample that confirms the reversal.
pub(super) fn rules(noise: SensorNoise, settings: &Settings) -> Vec<ReversalRule> {
    let thresholds = match settings.threshold {
        Some(threshold) => vec![threshold],
        None if noise.small_pairs == 0.0 && noise.sd > 0.0 => {
            vec![noise.threshold, LOW_THRESHOLD_IN_SD * noise.sd]
        }
        None => vec![noise.threshold],
    };
    if settings.causal {
        let rule = |threshold| ReversalRule { threshold, band: 0.0, timing: Timing::AtConfirmation };
        return thresholds.into_iter().map(rule).collect();
    }
    let timings = settings.timing.map_or(vec![Timing::AtSamples, Timing::BetweenSamples], |t| vec![t]);
    let mut rules = Vec::new();
    for &threshold in &thresholds {
        for &timing in &timings {
            let band = (3.0 * noise.sd).min(threshold / 2.0);
            rules.push(ReversalRule { threshold, band: 0.0, timing });
            if band > 0.0 {
                rules.push(ReversalRule { threshold, band, timing });
            }
        }
    }
    rules
}
