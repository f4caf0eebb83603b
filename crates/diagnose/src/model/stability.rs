//! Whether what `A` describes dies out.

use switchback_model::linear::is_stable;

/// Largest radius of a pole with which a model still counts as a simulator.
const SLOWEST: f64 = 0.9995;

/// Whether all poles lie inside the unit circle by a margin.
pub(crate) fn settles(a: &[f64]) -> bool {
    let scaled: Vec<f64> = (1..).zip(a).map(|(i, a)| a / SLOWEST.powi(i)).collect();
    is_stable(&scaled)
}
