//! The filter that turns equation errors into innovations.

use crate::model::augmented::NoiseLaw;

/// Samples before the first counted one that feed the whitening filter.
pub(crate) const LEAD: usize = 6;

/// The whitening filter `(1 + Σ dᵢq⁻ⁱ) / (1 + Σ cᵢq⁻ⁱ)`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Whitener {
    pub(crate) ar: Vec<f64>,
    pub(crate) ma: Vec<f64>,
}

impl Whitener {
    /// The filter of a noise law at the given `A` (white output noise passes `A`).
    pub(crate) fn new(law: &NoiseLaw, a: &[f64]) -> Self {
        let mut ma = law.ma.clone();
        if law.output_ratio > 0.0 {
            ma = crate::likelihood::spectral::factor_of_sum(law.output_ratio, a);
        }
        Self { ar: law.ar.clone(), ma }
    }

    /// The derivative of the innovations with respect to a coefficient of `g` added to `u`, from sample `from`.
    pub(crate) fn column(&self, g: &[f64], b: &[f64], from: usize) -> Vec<f64> {
        let first = from.saturating_sub(LEAD);
        let mut e = vec![0.0; g.len() - first];
        for (j, b) in b.iter().enumerate() {
            add_lagged(&mut e, g, first, (j + 1, -b));
        }
        let mut w = self.apply(e);
        w.drain(..(from - first).min(w.len()));
        w
    }

    pub(crate) fn apply(&self, e: Vec<f64>) -> Vec<f64> {
        let mut w = e;
        if !self.ar.is_empty() {
            let e = w.clone();
            for (i, d) in self.ar.iter().enumerate() {
                for (w, e) in w.iter_mut().skip(i + 1).zip(&e) {
                    *w += d * e;
                }
            }
        }
        if !self.ma.is_empty() {
            for t in 0..w.len() {
                let past = w[..t].iter().rev().zip(&self.ma);
                let sum: f64 = past.map(|(w, c)| c * w).sum();
                w[t] -= sum;
            }
        }
        w
    }
}

/// `e(t) += c·x(t−lag)` for `t ≥ first`; what lies before the record is its first sample.
pub(crate) fn add_lagged(e: &mut [f64], x: &[f64], first: usize, (lag, c): (usize, f64)) {
    let before = lag.saturating_sub(first).min(e.len());
    e[..before].iter_mut().for_each(|e| *e += c * x[0]);
    for (e, x) in e[before..].iter_mut().zip(&x[(first + before) - lag.min(first + before)..]) {
        *e += c * x;
    }
}
