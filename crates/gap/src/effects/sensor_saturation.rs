//! The sensor clips.
//!
//! ```text
//! y = min(max(x, low), high): many samples equal the extreme value exactly
//! ```
//!
//! Parameters: the limits, read off the ties. Samples at a limit, and those whose regressors reach one, only say that `x`
//! lies beyond: they are left out of the sum of squares. Stage: sensor. Confused with: sensor nonlinearity.

use super::{Scene, Variant};
use crate::assembly::Saturation;

/// Ties at an extreme that chance does not make, in samples.
const TIES: usize = 6;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for y in scene.campaign.fit().flat_map(|t| &t.y) {
        low = low.min(*y);
        high = high.max(*y);
    }
    let ties = |limit: f64| scene.campaign.fit().flat_map(|t| &t.y).filter(|y| **y == limit).count();
    // On a coarse lattice every value has ties: the extreme one must have more than its inner neighbour.
    let inner = |limit: f64| {
        let next = scene
            .campaign
            .fit()
            .flat_map(|t| &t.y)
            .filter(|y| **y != limit)
            .min_by(|a, b| (*a - limit).abs().total_cmp(&(*b - limit).abs()));
        next.map_or(0, |n| ties(*n))
    };
    let clipped = |limit: f64| ties(limit) >= TIES && ties(limit) > 3 * inner(limit);
    let (at_low, at_high) = (clipped(low), clipped(high));
    if !at_low && !at_high {
        return Vec::new();
    }
    let limits = Saturation {
        low: if at_low { low } else { f64::NEG_INFINITY },
        high: if at_high { high } else { f64::INFINITY },
    };
    vec![Variant::new(vec![Vec::new()], move |_, assembly| assembly.saturation = Some(limits))]
}
