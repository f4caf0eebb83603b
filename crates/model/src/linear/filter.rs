//! The difference equation itself.

/// `A(q⁻¹) y(t) = B(q⁻¹) u(t) + ξ(t)`, run from given starting values.
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + Σᵢ bᵢ u(t−i) + ξ(t),   i = 1…n
/// ```
///
/// `a` and `b` hold `a₁…aₙ` and `b₁…b_k`; the lengths may differ. Before the first sample, `y` is held at
/// `y_before` and `u` at `u_before` (for a steady state `y_before = B(1)/A(1)·u_before`). `xi` is the equation error, or
/// empty for none. Returns one output a sample of `u`.
///
/// # Panics
/// If `xi` is neither empty nor as long as `u`.
///
/// ```
/// # use switchback_model::linear::filter;
/// // A first-order lag at rest follows a unit step: 1 − 0.5ᵗ, one sample late.
/// assert_eq!(filter(&[-0.5], &[0.5], &[1.0, 1.0, 1.0], &[], 0.0, 0.0), [0.0, 0.5, 0.75]);
/// ```
pub fn filter(a: &[f64], b: &[f64], u: &[f64], xi: &[f64], y_before: f64, u_before: f64) -> Vec<f64> {
    assert!(xi.is_empty() || xi.len() == u.len(), "the equation error needs one value a sample of the input");
    let mut y = Vec::with_capacity(u.len());
    for t in 0..u.len() {
        let mut now = xi.get(t).copied().unwrap_or(0.0);
        for (i, ai) in a.iter().enumerate() {
            now -= ai * if t > i { y[t - i - 1] } else { y_before };
        }
        for (i, bi) in b.iter().enumerate() {
            now += bi * if t > i { u[t - i - 1] } else { u_before };
        }
        y.push(now);
    }
    y
}
