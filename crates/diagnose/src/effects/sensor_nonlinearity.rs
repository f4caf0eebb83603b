//! The sensor's characteristic is curved.
//!
//! ```text
//! x = y + θ₂y² + θ₃y³ + … up to y³ or y⁷,  or  y = x + γ₂x² + γ₃x³,  or  x = y + Σ hⱼ bump((y − cⱼ)/s);
//! likelihood with its Jacobian Σ ln dx/dy
//! ```
//!
//! Parameters: coefficients of the inverse characteristic or of the characteristic itself, or heights of twelve bumps over
//! the range of y; output in standard deviations about its mean. Stage: sensor.
//! The dynamics seem to depend on the level of y. Confused with: sensor saturation.

use super::{Card, Follows, Scene, Variant, parameter};
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::NonlinearParameter;
use crate::model::sensor::Bumps;
use crate::model::sensor_polynomial::SensorPolynomial;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::SensorSaturation],
    misreads: true,
    follows: Some(Follows::Steps),
    ..Card::of(Stage::Sensor, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let mut out: Vec<Variant> = [2, 6]
        .into_iter()
        .map(|count| {
            let names = ["theta2", "theta3", "theta4", "theta5", "theta6", "theta7"];
            let start = (0..count).map(|k| parameter(names[k], UNIT, 0.0, (-0.6, 0.6), 0.0005)).collect();
            Variant::new(vec![start], |p, augmented| augmented.curve.powers = p.to_vec())
        })
        .collect();
    let sensor_polynomial =
        [(0.0, 0.0), (0.0, 0.1), (0.0, 0.4), (0.0, -0.05), (0.2, 0.0), (-0.2, 0.0), (0.4, 0.1), (-0.4, 0.1)]
            .map(|(square, cube)| vec![gamma("gamma2", square), gamma("gamma3", cube)]);
    out.push(Variant::conditional(sensor_polynomial.into(), |p, augmented| {
        augmented.curve.sensor_polynomial = Some(SensorPolynomial::new(p[0], p[1]));
    }));
    out.push(bumps(scene, BUMPS));
    out
}

fn gamma(name: &'static str, value: f64) -> NonlinearParameter {
    parameter(name, UNIT, value, (-2.0, 2.0), 0.0005)
}

const UNIT: &str = "per standard deviation of y";

/// Bumps of the free curve.
const BUMPS: usize = 12;

fn bumps(scene: &Scene<'_>, count: usize) -> Variant {
    let readings = || scene.dataset.fit().flat_map(|t| &t.y);
    let low = readings().fold(f64::INFINITY, |l, &y| l.min(y));
    let high = readings().fold(f64::NEG_INFINITY, |h, &y| h.max(y));
    let spacing = (high - low) / (count - 1) as f64;
    let start = (0..count)
        .map(|_| {
            parameter("height", "standard deviations of y", 0.0, (-0.8 * spacing, 0.8 * spacing), 0.0005)
        })
        .collect();
    Variant::new(vec![start], move |p, augmented| {
        augmented.curve.bumps = Some(Bumps { first: low, spacing, heights: p.to_vec() });
    })
}
