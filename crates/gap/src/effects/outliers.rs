//! Rare large errors.
//!
//! ```text
//! w ~ (1−ε)·N(0, σ²) + ε·N(0, κ²σ²)
//! ```
//!
//! Parameters: share `ε` and ratio `κ`, found by expectation–maximisation. Stage: disturbance. Heavy tails without a place.
//! Confused with: input noise, a border jump between grid points.

use super::{Scene, Variant};
use crate::records::campaign::Track;

/// Exact repeats of the last output, as a share of the samples, that chance does not make: a sensor that holds its value
/// leaves large errors too, but is another cause.
const REPEATS: f64 = 0.004;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let outputs = || scene.campaign.fit().flat_map(|track| track.y.iter().copied());
    let (least, most) =
        (outputs().fold(f64::INFINITY, f64::min), outputs().fold(f64::NEG_INFINITY, f64::max));
    // At its limits a clipping sensor repeats itself, too.
    let inside = |y: f64| least < y && y < most;
    let repeated = |track: &Track| track.y.windows(2).filter(|w| w[0] == w[1] && inside(w[0])).count();
    let repeats: usize = scene.campaign.fit().map(repeated).sum();
    let count = outputs().count();
    let rounding_is_known = scene.fit.assembly.noise.lattice.is_some();
    if !rounding_is_known && repeats as f64 > REPEATS * count as f64 {
        return Vec::new();
    }
    let mut variant =
        Variant::new(vec![Vec::new()], |_, assembly| assembly.noise.mixture = Some((0.01, 8.0)));
    // Two parameters that expectation–maximisation finds outside the count.
    variant.handicap = 20.0;
    vec![variant]
}
