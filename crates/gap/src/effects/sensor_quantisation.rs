//! The sensor rounds.
//!
//! ```text
//! y = q·round(x/q): all differences of y are multiples of q; rounding adds noise of variance q²/12 to the output
//! ```
//!
//! Parameter: the step `q`, read off the lattice. Stage: sensor. Confused with: output noise, which leaves no lattice.
//! A lattice too fine to matter (its noise below [`MATERIAL`] of the innovations) is no cause.

use super::{Scene, Variant};

/// Least share of the innovations' variance that rounding must make to be a cause.
const MATERIAL: f64 = 0.05;
/// Deviance that a lattice is worth: chance leaves none.
const LATTICE: f64 = -2000.0;

pub(super) fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let Some(step) = lattice(scene) else { return Vec::new() };
    let a_energy = 1.0 + scene.fit.linear.a.iter().map(|a| a * a).sum::<f64>();
    let rounding = step * step / 12.0;
    if rounding * a_energy < MATERIAL * scene.fit.variance {
        return Vec::new();
    }
    let own = super::own("log_ratio", "ln variance ratio", 0.0, (-7.0, 9.0), 0.02);
    let mut variant = Variant::new(vec![vec![own]], move |p, assembly| {
        assembly.noise.output_ratio = p[0].exp();
        assembly.noise.lattice = Some(step);
    });
    variant.handicap = LATTICE;
    vec![variant]
}

/// The step of the lattice that all outputs lie on.
fn lattice(scene: &Scene<'_>) -> Option<f64> {
    let mut values: Vec<f64> = scene.campaign.fit().flat_map(|t| t.y.iter().copied()).collect();
    let count = values.len();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    if values.len() * 3 > count * 2 || values.len() < 3 {
        return None;
    }
    let step = values.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    let origin = values[0];
    let fits = values
        .iter()
        .filter(|v| {
            let k = (*v - origin) / step;
            (k - k.round()).abs() < 0.05
        })
        .count();
    (fits * 100 >= values.len() * 98).then_some(step)
}
