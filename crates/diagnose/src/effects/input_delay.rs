//! The input acts later than recorded.
//!
//! ```text
//! ũ(t) = (1−δ)·u(t−k) + δ·u(t−k−1),            delay = k + δ      the actuator's response is late
//! ũ(t) = F[(1−δ)·v + δ·v(·−1)](t−k)                                the positions are
//! ```
//!
//! Parameter: `delay` in samples (0…10). Stage: input. Confused with: extra pole, resonance (all delay the response).

use super::{Card, Room, Scene, Search, Variant, outlasts_the_records, parameter};
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::NonlinearParameter;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::ExtraPole, Effect::Resonance],
    dominates_dynamics: true,
    room: Some(Room::Delay),
    ..Card::of(Stage::Input, variants)
};

/// Delays of the positions tried within the first sample, and within each of the next few. A branch taken a sample too late costs
/// more than any smooth part gains: the likelihood has a corner at every ratio of two moves that meet at a reversal.
const WITHIN_THE_FIRST: [f64; 9] = [0.015, 0.03, 0.06, 0.12, 0.25, 0.4, 0.6, 0.8, 0.95];
const WITHIN_A_LATER: [f64; 4] = [0.05, 0.2, 0.5, 0.8];

fn variants(_: &Scene<'_>) -> Vec<Variant> {
    let delay = |d: f64, step: f64| vec![parameter("delay", "samples", d, (0.0, 10.0), step)];
    let responses = [0.15, 0.4, 0.6, 0.85, 1.15, 1.4, 1.6, 1.85, 2.2, 2.5, 2.8, 3.3, 3.7, 5.0];
    let response = Variant::conditional(responses.map(|d| delay(d, 0.02)).into(), |p, augmented| {
        augmented.delay = p[0];
    });
    // B takes a whole sample where it has room: every whole sample is a valley of its own.
    let whole = |nonlinear: &[NonlinearParameter]| nonlinear[0].value.floor() as i64;
    let response = Variant { climbs: response.starts.len(), valley: Some(whole), ..response };
    let later = [1.0, 2.0, 3.0]
        .into_iter()
        .flat_map(|k| WITHIN_A_LATER.map(|effect_term| (k + effect_term, effect_term)));
    let starts = WITHIN_THE_FIRST.into_iter().map(|effect_term| (effect_term, effect_term)).chain(later);
    let positions =
        Variant::new(starts.map(|(d, effect_term)| delay(d, 0.3 * effect_term)).collect(), |p, augmented| {
            augmented.delay = p[0].floor();
            augmented.late = p[0] - augmented.delay;
        });
    let positions = Variant { search: Search::Profile, ..positions };
    [response, positions].map(|law| law.sound_if(|_, fit| !outlasts_the_records(fit))).into()
}
