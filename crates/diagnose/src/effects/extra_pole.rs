//! A lag that the order of the model has no room for.
//!
//! ```text
//! ũ = (1−p)/(1−p q⁻¹) u            an actuator: the equation error does not pass it
//! (1−p q⁻¹) A y = B u + ξ          a lag of the plant: the equation error passes it
//! ũ = (c + d q⁻¹)/(1−p q⁻¹) u      a lag that lets part of its input through
//! ũ = (1−p)²/(1−p q⁻¹)² u          two equal lags
//! ```
//!
//! Parameter: `pole` (0.004…0.98; with feedthrough from 0.15, below which it is a delay; from 0.5 where what a record began with still shows). Stage: dynamics. Confused with: input delay, resonance, creep.

use super::{Card, Room, Scene, Sound, Variant, fitted_scaled_records, outlasts_the_records, parameter};
use crate::effect::{Effect, Stage};
use crate::fitted_parameter::FittedParameter;
use crate::likelihood::engine::Fit;
use crate::model::augmented::EquationColumn;
use crate::simulation::initial_conditions::begins_as_a_filter;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::InputDelay, Effect::Resonance, Effect::Creep],
    dominates_dynamics: true,
    room: Some(Room::Order),
    // One pole before the plant is the same on every machine: the cause leaves nothing, delays and lasting errors do.
    reported_first: |reading| {
        let pole = reading.searched.iter().find(|o| o.name == "pole");
        pole.and_then(time_constant).into_iter().collect()
    },
    ..Card::of(Stage::Dynamics, variants)
};

/// One kind of lag.
struct Lag {
    poles: usize,
    /// Whether the equation error passes it.
    passes: bool,
    /// Whether part of its input goes through.
    feeds_through: bool,
    /// How far a slow lag was behind when a record began is unknown.
    slow: bool,
}

const FAST: Lag = Lag { poles: 1, passes: false, feeds_through: false, slow: false };
const LAGS: [Lag; 6] = [
    FAST,
    Lag { passes: true, ..FAST },
    Lag { feeds_through: true, slow: true, ..FAST },
    Lag { poles: 2, ..FAST },
    Lag { slow: true, ..FAST },
    Lag { poles: 2, slow: true, ..FAST },
];

/// Frequency and kind of what a pole, and a second one at the same place, leave of what a record began with: `pᵗ` and `t·pᵗ`, which
/// is the limit of `pᵗ sin(ωt)/ω`.
const MODES: [(f64, bool); 2] = [(0.0, false), (1e-3, true)];

impl Lag {
    /// Least pole, and poles to start from.
    fn poles(&self) -> (f64, &'static [f64]) {
        match (self.slow, self.feeds_through) {
            (false, _) => (0.004, &[0.03, 0.2, 0.5, 0.8]),
            // What bypasses a lag lets the lag be slow.
            (true, true) => (0.15, &[0.3, 0.5, 0.7, 0.85, 0.93, 0.97]),
            (true, false) => (0.5, &[0.8, 0.93, 0.97]),
        }
    }
}

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    LAGS.iter()
        .map(|lag| {
            let (least, poles) = lag.poles();
            let starts =
                poles.iter().map(|&p| vec![parameter("pole", "1", p, (least, 0.98), 0.003)]).collect();
            let scaled_records = if lag.slow { fitted_scaled_records(scene.dataset) } else { Vec::new() };
            // What comes twice begins with more than one exponential.
            let sound: Sound = match lag.poles {
                1 => |p, fit| is_a_lag(fit) && begins_as_a_filter(fit, p[0], 1.0),
                _ => |_, fit| is_a_lag(fit),
            };
            let law = Variant::conditional(starts, move |p, augmented| {
                for _ in 0..lag.poles {
                    augmented.filter(&[1.0 - p[0]], &[1.0, -p[0]]);
                }
                augmented.extra_b += usize::from(lag.feeds_through);
                let modes = &MODES[..lag.poles];
                for &scaled in &scaled_records {
                    let decay =
                        |&(frequency, sine)| EquationColumn::Decay { scaled, radius: p[0], frequency, sine };
                    augmented.equation_columns.extend(modes.iter().map(decay));
                }
                if lag.passes {
                    augmented.noise.ar = crate::model::augmented::times_monic(&augmented.noise.ar, &[-p[0]]);
                }
            });
            law.sound_if(sound)
        })
        .collect()
}

/// Least magnitude of the fastest pole of `A`.
const ANALYSED: f64 = 0.03;

/// A pole in series is no extra one where `A` has given up one of its own: the plant's noise then is that of its output.
fn keeps_its_poles(fit: &Fit) -> bool {
    let in_series = fit.augmented.denominator.len() > 1;
    let a = &fit.linear.a;
    let before_last = if a.len() > 1 { a[a.len() - 2].abs() } else { 1.0 };
    // Vieta: far poles apart, the last two coefficients have the ratio of the fastest.
    !in_series || a.last().is_none_or(|last| last.abs() > ANALYSED * before_last)
}

/// Whether a lag is still one beside `A`.
fn is_a_lag(fit: &Fit) -> bool {
    keeps_its_poles(fit) && !outlasts_the_records(fit)
}

/// `ln τ` of a lag with the pole `p = exp(−1/τ)`, `τ` in samples; nothing where the pole is none of a lag.
fn time_constant(pole: &FittedParameter) -> Option<FittedParameter> {
    let logarithm = |p: f64| -(-p.ln()).ln();
    let is_of_a_lag = pole.value > 0.0 && pole.value < 1.0;
    is_of_a_lag.then(|| FittedParameter {
        name: "log_tau",
        unit: "ln samples",
        value: logarithm(pole.value),
        ci90: pole.ci90.map(logarithm),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_is_a_time_constant() {
        let pole = |value: f64, half: f64| FittedParameter {
            name: "pole",
            unit: "1",
            value,
            ci90: [value - half, value + half],
        };
        let of = |tau: f64| (-1.0 / tau).exp();
        let tau = time_constant(&pole(of(10.0), 0.005)).expect("a lag");
        assert!((tau.value.exp() - 10.0).abs() < 1e-9);
        let ends = tau.ci90.map(|end| of(end.exp()) - of(10.0));
        assert!((ends[0] + 0.005).abs() < 1e-9 && (ends[1] - 0.005).abs() < 1e-9, "{ends:?}");
        assert!(time_constant(&pole(-0.3, 0.1)).is_none() && time_constant(&pole(1.0, 0.1)).is_none());
        // An interval that reaches a pole that forgets nothing ends nowhere.
        assert!(time_constant(&pole(0.999, 0.01)).is_some_and(|tau| tau.ci90[1].is_nan()));
    }
}
