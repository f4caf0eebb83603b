//! The library of effects: one file an effect, each with its law, its parameters, what it leaves in the data and what it
//! is confused with.
//!
//! An effect is a handful of [`Variant`]s: laws that physics offers for the same cause, each a function from own
//! parameters to changes of an [`Assembly`]. The same assembly is fitted ([`crate::likelihood::engine`]) and simulated
//! ([`crate::simulation::simulate`]), and effects compose by being applied one after the other.

mod backlash;
mod border_resolution;
mod border_wear;
mod coloured_noise;
mod creep;
mod extra_pole;
mod gain_drift;
mod gradual_transition;
mod input_delay;
mod input_noise;
mod outliers;
mod output_noise;
mod periodic_disturbance;
mod rate_dependence;
mod resonance;
mod sensor_drift;
mod sensor_nonlinearity;
mod sensor_quantisation;
mod sensor_saturation;
mod speed;
mod stribeck;

use std::sync::Arc;

use crate::effect::Effect;
use crate::likelihood::engine::{Fit, Own};
use crate::model::assembly::Assembly;
use crate::model::borders::Grid;
use crate::records::campaign::Campaign;

/// How the own parameters are searched after the starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Search {
    /// Gauss–Newton together with everything else.
    Smooth,
    /// The starts are compared with their own parameters held, which is a nearly linear problem; then as `Smooth`.
    Conditional,
    /// A profile refined around its best point: the likelihood has corners.
    Profile,
    /// The same where the own parameters only weigh the samples: the rest hardly moves with them, and is fitted afterwards.
    Weights,
}

/// The change an effect makes to an assembly, given its own parameters.
pub(crate) type Apply = Arc<dyn Fn(&[f64], &mut Assembly) + Send + Sync>;

/// Whether a law, given its fitted own parameters, is still a law of its effect, not the limit at which it is another one.
pub(crate) type Sound = fn(&[f64], &Fit) -> bool;

/// The effect that a law is one of, given its fitted own parameters: where a coefficient may have either sign, a name includes it.
pub(crate) type Naming = fn(&[f64], &Fit) -> Effect;

/// One law of an effect.
pub(crate) struct Variant {
    /// Points the search starts from; all hold the same parameters.
    pub(crate) starts: Vec<Vec<Own>>,
    /// Further points where everything is identified anew: at a start where the law changes nothing that identifies what is known.
    pub(crate) afresh: Vec<Vec<Own>>,
    pub(crate) search: Search,
    /// Starts from which everything is fitted together, where the own parameters are conditions of the rest.
    pub(crate) climbs: usize,
    /// Which valley a start lies in, where only the likeliest of each is climbed from.
    pub(crate) valley: Option<fn(&[Own]) -> i64>,
    pub(crate) apply: Apply,
    pub(crate) sound: Sound,
    /// Which effect a fit is one of, where that depends on its signs.
    pub(crate) naming: Option<Naming>,
    /// A finer border grid that comes with the law.
    pub(crate) grid: Option<Grid>,
    /// Added to the deviance: evidence that the innovations do not show, or a penalty.
    pub(crate) handicap: f64,
}

/// Climbs of a law whose starts are stages of one valley.
const CLIMBS: usize = 3;

impl Search {
    /// Whether own parameters are moved one by one, without derivatives.
    pub(crate) fn is_by_pattern(self) -> bool {
        matches!(self, Self::Profile | Self::Weights)
    }
}

impl Variant {
    fn new(starts: Vec<Vec<Own>>, apply: impl Fn(&[f64], &mut Assembly) + Send + Sync + 'static) -> Self {
        Self {
            starts,
            afresh: Vec::new(),
            search: Search::Smooth,
            climbs: CLIMBS,
            valley: None,
            apply: Arc::new(apply),
            sound: |_, _| true,
            naming: None,
            grid: None,
            handicap: 0.0,
        }
    }

    fn conditional(
        starts: Vec<Vec<Own>>,
        apply: impl Fn(&[f64], &mut Assembly) + Send + Sync + 'static,
    ) -> Self {
        Self { search: Search::Conditional, ..Self::new(starts, apply) }
    }

    /// The same law, of its effect only where a fit is sound.
    fn sound_if(self, sound: Sound) -> Self {
        Self { sound, ..self }
    }

    /// The same law, of another effect where its signs say so.
    fn named_by(self, naming: Naming) -> Self {
        Self { naming: Some(naming), ..self }
    }
}

/// What an effect may look at when it proposes its variants.
pub(crate) struct Scene<'a> {
    pub(crate) campaign: &'a Campaign,
    /// The best model so far.
    pub(crate) fit: &'a Fit,
    /// Its innovations on the fit records.
    pub(crate) innovations: &'a [Vec<f64>],
}

/// The variants of an effect that make sense on these records; empty where the records rule it out.
pub(crate) fn variants(effect: Effect, scene: &Scene<'_>) -> Vec<Variant> {
    match effect {
        Effect::InputDelay => input_delay::variants(),
        Effect::InputNoise => input_noise::variants(scene),
        Effect::Backlash => backlash::variants(scene),
        Effect::GradualTransition => gradual_transition::variants(scene),
        Effect::RateDependence => rate_dependence::variants(scene),
        Effect::Creep => creep::variants(scene),
        Effect::BorderWear => border_wear::variants(),
        Effect::Stribeck => stribeck::variants(scene),
        Effect::ExtraPole => extra_pole::variants(scene),
        Effect::Resonance => resonance::variants(scene),
        Effect::GainDrift => gain_drift::variants(),
        Effect::ColouredNoise => coloured_noise::variants(scene),
        Effect::OutputNoise => output_noise::variants(),
        Effect::Outliers => outliers::variants(scene),
        Effect::PeriodicDisturbance => periodic_disturbance::variants(scene),
        Effect::SensorDrift => sensor_drift::variants(scene),
        Effect::SensorSaturation => sensor_saturation::variants(scene),
        Effect::SensorQuantisation => sensor_quantisation::variants(scene),
        Effect::SensorNonlinearity => sensor_nonlinearity::variants(scene),
        Effect::BorderResolution => border_resolution::variants(scene),
    }
}

pub(crate) use gain_drift::free_course;

/// Whether a pole of `A` dies away in no record: it follows a drift, and a lag has taken its place.
fn outlasts_the_records(fit: &Fit) -> bool {
    let longest = fit.design.tracks.iter().map(|track| track.x.len()).max().unwrap_or(0) as f64;
    fit.linear.poles().into_iter().any(|pole| pole.norm() > (-1.0 / longest.max(1.0)).exp())
}

/// Whether a fitted effect is but the colour of the noise under another name.
pub(crate) fn is_coloured_noise(effect: Effect, fit: &Fit) -> bool {
    effect == Effect::Resonance && resonance::is_coloured_noise(fit)
}

/// Typical speed of the free records, strokes per sample: the median of the moves.
fn typical_speed(campaign: &Campaign) -> f64 {
    let mut speeds: Vec<f64> = campaign
        .fit()
        .filter(|t| !t.is_pulsed())
        .flat_map(|t| t.v.windows(2).map(|w| (w[1] - w[0]).abs()))
        .filter(|s| *s > 0.0)
        .collect();
    if speeds.is_empty() {
        return 0.1;
    }
    let middle = speeds.len() / 2;
    *speeds.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Numbers of the tracks that are fitted.
fn fitted_tracks(campaign: &Campaign) -> Vec<usize> {
    campaign.tracks.iter().enumerate().filter(|(_, t)| t.is_fit()).map(|(i, _)| i).collect()
}

/// A parameter with its bounds; the derivative step is a thousandth of the range unless told.
fn own(name: &'static str, unit: &'static str, value: f64, bounds: (f64, f64), step: f64) -> Own {
    Own { name, unit, value, low: bounds.0, high: bounds.1, step }
}

#[cfg(test)]
mod tests;
