//! The parameters that are linear or bilinear given the effects' nonlinear ones.

use nalgebra::{Complex, DMatrix};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::augmented::AugmentedModel;

/// `a`, `b`, border values and disturbance coefficients.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Linear {
    /// `a₁…aₙ`.
    pub(crate) a: Vec<f64>,
    /// `b₁…`.
    pub(crate) b: Vec<f64>,
    /// Border values, then the coefficients of the border columns.
    pub(crate) f: Vec<f64>,
    /// Coefficients of the equation columns.
    pub(crate) d: Vec<f64>,
}

impl Linear {
    pub(crate) fn len(&self) -> usize {
        self.a.len() + self.b.len() + self.f.len() + self.d.len()
    }

    /// All parameters in one vector: a, b, f, d.
    pub(crate) fn flat(&self) -> Vec<f64> {
        [&self.a[..], &self.b, &self.f, &self.d].concat()
    }

    /// `self + step·by`.
    pub(crate) fn moved(&self, by: &[f64], step: f64) -> Self {
        let mut out = self.clone();
        let all = out.a.iter_mut().chain(&mut out.b).chain(&mut out.f).chain(&mut out.d);
        for (x, d) in all.zip(by) {
            *x += step * d;
        }
        out
    }

    /// The same with zeros for what an augmented model adds, the border values on a grid of the given size.
    pub(crate) fn padded(&self, grid: usize, augmented: &AugmentedModel) -> Self {
        let mut p = self.clone();
        p.b.resize(p.a.len() + augmented.extra_b, 0.0);
        p.f.resize(grid + augmented.border_columns.len(), 0.0);
        p.d.resize(augmented.equation_columns.len(), 0.0);
        p
    }

    /// What innovations of white equation errors make of the output: each record through `1/A`.
    pub(crate) fn behind_poles(&self, innovations: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let through = |w: &Vec<f64>| {
            let mut x: Vec<f64> = Vec::with_capacity(w.len());
            for (t, w) in w.iter().enumerate() {
                let past = self.a.iter().enumerate().take(t).map(|(i, a)| a * x[t - 1 - i]);
                x.push(w - past.sum::<f64>());
            }
            x
        };
        innovations.iter().map(through).collect()
    }

    /// Roots of `1 + Σ aᵢ z⁻ⁱ`.
    pub(crate) fn poles(&self) -> Vec<Complex<f64>> {
        let n = self.a.len();
        let companion = DMatrix::from_fn(n, n, |i, j| match i {
            0 => -self.a[j],
            _ => f64::from(u8::from(i == j + 1)),
        });
        companion.complex_eigenvalues().iter().copied().collect()
    }

    /// Samples until a twentieth of a move is left: `ln 0.05 / ln |p|` for the slowest pole `p`; all there are where it never settles.
    pub(crate) fn settling(&self) -> usize {
        const SETTLED: f64 = 0.05;
        let slowest = self.poles().iter().map(|pole| pole.norm()).fold(0.0, f64::max);
        match slowest {
            r if r >= 1.0 => usize::MAX,
            r if r <= 0.0 => 1,
            r => (SETTLED.ln() / r.ln()).ceil() as usize,
        }
    }

    /// The same system with `Σ b² = 1`: fixes the scale shared by `b` and `f`.
    pub(crate) fn gauged(mut self) -> Self {
        let norm = self.b.iter().map(|b| b * b).sum::<f64>().sqrt();
        if norm > 0.0 && norm.is_finite() {
            self.b.iter_mut().for_each(|b| *b /= norm);
            self.f.iter_mut().for_each(|f| *f *= norm);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behind_poles_is_the_inverse_of_the_equation() {
        let model = Linear { a: vec![-1.2, 0.5], ..Linear::default() };
        let y: Vec<f64> = (0..50).map(|t| (f64::from(t) * 0.4).sin()).collect();
        let at = |t: usize, lag: usize| if t >= lag { y[t - lag] } else { 0.0 };
        let errors = (0..50).map(|t| at(t, 0) - 1.2 * at(t, 1) + 0.5 * at(t, 2)).collect();
        for (found, y) in model.behind_poles(&[errors])[0].iter().zip(&y) {
            assert!((found - y).abs() < 1e-12);
        }
    }
}
