//! The operator by the letter of its definition: slow, obvious, and what the streaming operator is tested against.

use super::{Branch, SwitchedHysteresis};

/// `u = F[v]` (2.3), each sample on its own from the whole past of `v`.
///
/// ```text
/// k = the last time ≤ t at which v(k) ≠ v(k−1)
/// u(t) = C_a(v(k)) if v(k) > v(k−1),   C_d(v(k)) if v(k) < v(k−1),   before if there is no such k
/// ```
///
/// Standing still keeps `u`, so unrolling (2.3) back to the last move gives this. It carries no state and looks back
/// through every rest, O(N²) at worst: a reference for tests; use [`SwitchedHysteresis::output`] otherwise.
///
/// ```
/// use switchback_model::hysteresis::{Interval, LeafSpring, SwitchedHysteresis, output_by_definition};
/// let spring = LeafSpring::constant(2.0, 0.5)?;
/// let hysteresis = SwitchedHysteresis::new(Interval::new(-1.0, 1.0)?, Box::new(spring))?;
/// let v = [0.0, 1.0, 1.0, 0.25];
/// assert_eq!(output_by_definition(&hysteresis, &v, 9.0), [9.0, 2.5, 2.5, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn output_by_definition(hysteresis: &SwitchedHysteresis, v: &[f64], before: f64) -> Vec<f64> {
    let at = |t: usize| match (1..=t).rev().find(|&k| v[k] != v[k - 1]) {
        Some(k) if v[k] > v[k - 1] => hysteresis.border(Branch::Ascending, v[k]),
        Some(k) => hysteresis.border(Branch::Descending, v[k]),
        None => before,
    };
    (0..v.len()).map(at).collect()
}
