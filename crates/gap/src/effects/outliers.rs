//! Rare large errors.
//!
//! ```text
//! w ~ (1−ε)·N(0, σ²) + ε·N(0, κ²σ²)
//! ```
//!
//! Parameters: share `ε` and ratio `κ`, found by expectation–maximisation. Stage: disturbance. Heavy tails without a place.
//! Confused with: input noise, a border jump between grid points.

use super::Variant;

pub(super) fn variants() -> Vec<Variant> {
    let mut variant =
        Variant::new(vec![Vec::new()], |_, assembly| assembly.noise.mixture = Some((0.01, 8.0)));
    // Two parameters that expectation–maximisation finds outside the count.
    variant.handicap = 20.0;
    vec![variant]
}
