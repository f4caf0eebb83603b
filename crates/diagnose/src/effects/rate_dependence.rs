//! The borders depend on the speed of the input.
//!
//! ```text
//! u = C(v) + c·branch·(r/r₀)^power,   r = |v(t) − v(t−1)|, r₀ its median
//! u = C(v) + w·(r/r₀)^power·half(v)·branch,   half(v) = ½(C_a − C_d)              the whole loop widens
//! ```
//!
//! Parameters: `power` (0.1…3); the coefficient is estimated with the borders, `widening` w (−0.9…20) is not. Stage: operator. Fast records have wider loops
//! than slow ones; where the fit says that they are narrower it is [Stribeck friction](super::stribeck), and a fit of that which says that they are
//! wider is of this effect ([`super::speed`]). While the input rests, the term keeps its last value or vanishes. Confused with: Stribeck
//! friction (which falls with speed), creep.

use super::{Card, Scene, Variant, parameter, speed, typical_speed};
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::Fit;
use crate::model::augmented::{BorderColumn, Resting, Speeds, Widening};

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::Stribeck, Effect::Creep],
    dominates_dynamics: true,
    // A law of falling friction that fitted one that rises.
    renamed: &[("stribeck_speed", "speed_scale")],
    ..Card::of(Stage::Operator, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let scale = typical_speed(scene.dataset);
    let mut out = Vec::new();
    for while_resting in [Resting::Held, Resting::Zero] {
        // Viscous friction is the commonest.
        let starts = [0.4, 1.0].iter().map(|&p| vec![parameter("power", "1", p, (0.1, 3.0), 0.02)]).collect();
        let law = Variant::conditional(starts, move |p, augmented| {
            augmented.border_columns.push(BorderColumn::Speed { power: p[0], scale, while_resting });
        });
        out.push(law.named_by(name_of_a_column));
    }
    let starts = [(0.2, 0.3), (1.0, 0.3), (0.2, 1.0), (1.0, 1.0)].map(|(share, power)| {
        vec![
            parameter("widening", "half widths of the loop", share, (-0.9, 20.0), 0.005),
            parameter("power", "1", power, (0.1, 3.0), 0.02),
        ]
    });
    let widening = Variant::conditional(starts.into(), move |p, augmented| {
        augmented.widening = Some(Widening { share: p[0], power: p[1], scale, speeds: Speeds::High });
    });
    out.push(widening.named_by(|p, _| speed::of_a_widening(Speeds::High, p[0])));
    out
}

fn name_of_a_column(p: &[f64], fit: &Fit) -> Effect {
    let is_it = |c: &BorderColumn| matches!(c, BorderColumn::Speed { power, .. } if *power == p[0]);
    speed::of_a_column(fit, is_it).unwrap_or(Effect::RateDependence)
}
