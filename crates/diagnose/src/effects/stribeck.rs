//! Friction that falls as the speed rises from zero.
//!
//! ```text
//! u = C(v) + c·g(t),   g = branch·exp(−(r/r_s)^power),   r = |v(t) − v(t−1)|
//! u = C(v) + w·|g(t)|·half(v)·branch,   half(v) = ½(C_a − C_d)                 the whole loop is wider when it is slow
//! the same with z for g,   z(t) = g − (g − z(t−1))·exp(−r/length)               a bristle bends first (LuGre)
//! ```
//!
//! Parameters: Stribeck speed `r_s` in strokes per sample, `power` (0.3…4; 2 is the Gaussian law, below 1 near the hyperbolic one); `length` in strokes (0.002…0.2); the coefficient is estimated with the borders, `widening` w
//! (−0.9…20) is not. Stage:
//! operator. Slow passages show a wider loop than fast ones, and only below `r_s`; where the fit says that it is narrower, friction rises
//! with speed, and the law is one of [rate dependence](super::rate_dependence). Confused with: rate dependence.

use super::{Card, Scene, Variant, parameter, speed, typical_speed};
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::Fit;
use crate::model::augmented::{BorderColumn, Resting, Speeds, Widening};

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::RateDependence],
    dominates_dynamics: true,
    ..Card::of(Stage::Operator, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let typical = typical_speed(scene.dataset);
    let slow = |(share, power): (f64, f64)| {
        let scale = share * typical;
        let range = (0.02 * typical, 20.0 * typical);
        vec![
            parameter("stribeck_speed", "strokes per sample", scale, range, 0.02 * scale),
            parameter("power", "1", power, (0.3, 4.0), 0.02),
        ]
    };
    let low_speed = |while_resting| {
        let starts = [(0.2, 1.0), (0.7, 1.0), (0.5, 2.0), (2.0, 2.0), (6.0, 2.0)].map(slow);
        Variant::conditional(starts.into(), move |p, augmented| {
            let column = BorderColumn::LowSpeed { power: p[1], scale: p[0], while_resting };
            augmented.border_columns.push(column);
        })
        .named_by(|p, fit| {
            let of_it = |power: f64, scale: f64| [scale, power] == p[..2];
            named(fit, |c| matches!(*c, BorderColumn::LowSpeed { power, scale, .. } if of_it(power, scale)))
        })
    };
    let bends = parameter("length", "strokes", 0.02, (0.002, 0.2), 0.001);
    let starts =
        [(0.7, 1.0), (0.5, 2.0), (2.0, 2.0), (6.0, 2.0)].map(|start| [slow(start), vec![bends]].concat());
    let bristle = Variant::conditional(starts.into(), |p, augmented| {
        let column = BorderColumn::Bristle { power: p[1], scale: p[0], length: p[2] };
        augmented.border_columns.push(column);
    });
    let bristle = bristle.named_by(|p, fit| {
        let of_it = |power: f64, scale: f64, length: f64| [scale, power, length] == p[..3];
        named(
            fit,
            |c| matches!(*c, BorderColumn::Bristle { power, scale, length } if of_it(power, scale, length)),
        )
    });
    let share = parameter("widening", "half widths of the loop", 0.3, (-0.9, 20.0), 0.005);
    let starts =
        [(0.2, 1.0), (0.7, 1.0), (0.5, 2.0), (2.0, 2.0)].map(|start| [vec![share], slow(start)].concat());
    let wider = Variant::conditional(starts.into(), |p, augmented| {
        augmented.widening = Some(Widening { share: p[0], power: p[2], scale: p[1], speeds: Speeds::Low });
    });
    let wider = wider.named_by(|p, _| speed::of_a_widening(Speeds::Low, p[0]));
    vec![low_speed(Resting::Held), low_speed(Resting::Zero), bristle, wider]
}

fn named(fit: &Fit, is_it: impl Fn(&BorderColumn) -> bool) -> Effect {
    speed::of_a_column(fit, is_it).unwrap_or(Effect::Stribeck)
}
