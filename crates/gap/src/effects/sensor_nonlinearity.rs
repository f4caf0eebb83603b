//! The sensor's characteristic is curved.
//!
//! ```text
//! x = y + θ₂y² + θ₃y³ + … up to y², y³, y⁴ or y⁷,  or  x = y + Σ hⱼ bump((y − cⱼ)/s);   likelihood with its Jacobian Σ ln dx/dy
//! ```
//!
//! Parameters: coefficients of the inverse characteristic, or heights of six bumps over the range of y; output in standard
//! deviations about its mean. Stage: sensor.
//! The dynamics seem to depend on the level of y. Confused with: sensor saturation.

use super::{Scene, Variant, own};
use crate::sensor::Bumps;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let mut out: Vec<Variant> = [1, 2, 3, 6]
        .into_iter()
        .map(|count| {
            let names = ["theta2", "theta3", "theta4", "theta5", "theta6", "theta7"];
            let start = (0..count)
                .map(|k| own(names[k], "per standard deviation of y", 0.0, (-0.6, 0.6), 0.0005))
                .collect();
            Variant::new(vec![start], |p, assembly| assembly.curve.powers = p.to_vec())
        })
        .collect();
    out.push(bumps(scene));
    out
}

/// Bumps of the free curve.
const BUMPS: usize = 6;

fn bumps(scene: &Scene<'_>) -> Variant {
    let readings = || scene.campaign.fit().flat_map(|t| &t.y);
    let low = readings().fold(f64::INFINITY, |l, &y| l.min(y));
    let high = readings().fold(f64::NEG_INFINITY, |h, &y| h.max(y));
    let spacing = (high - low) / (BUMPS - 1) as f64;
    let start = (0..BUMPS)
        .map(|_| own("height", "standard deviations of y", 0.0, (-0.8 * spacing, 0.8 * spacing), 0.0005))
        .collect();
    Variant::new(vec![start], move |p, assembly| {
        assembly.curve.bumps = Some(Bumps { first: low, spacing, heights: p.to_vec() });
    })
}
