//! A model somebody else identified.

/// A model somebody else identified: `A(q⁻¹) y = B(q⁻¹) u` with `u` on two tabulated borders, linear in between.
#[derive(Debug, Clone, PartialEq)]
pub struct NominalModel {
    /// `a₁…aₙ`.
    pub a: Vec<f64>,
    /// `b₁…bₙ`.
    pub b: Vec<f64>,
    /// Points `(v, C_d(v))`, by increasing `v`; at least two.
    pub descending: Vec<(f64, f64)>,
    /// Points `(v, C_a(v))`, by increasing `v`; at least two.
    pub ascending: Vec<(f64, f64)>,
}
