//! The filter that turns equation errors into innovations.

use crate::assembly::NoiseLaw;

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
            ma = crate::spectral::factor_of_sum(law.output_ratio, a);
        }
        Self { ar: law.ar.clone(), ma }
    }

    /// The derivative of the innovations with respect to a coefficient of `g` added to `u`, from sample `from`.
    pub(crate) fn column(&self, g: &[f64], b: &[f64], from: usize) -> Vec<f64> {
        let first = from.saturating_sub(LEAD);
        let e: Vec<f64> = (first..g.len())
            .map(|t| -b.iter().enumerate().map(|(j, b)| b * g[t.saturating_sub(j + 1)]).sum::<f64>())
            .collect();
        let mut w = self.apply(e);
        w.drain(..(from - first).min(w.len()));
        w
    }

    pub(crate) fn apply(&self, e: Vec<f64>) -> Vec<f64> {
        if self.ar.is_empty() && self.ma.is_empty() {
            return e;
        }
        let mut w = Vec::with_capacity(e.len());
        for t in 0..e.len() {
            let mut now = e[t];
            for (i, d) in self.ar.iter().enumerate() {
                if t > i {
                    now += d * e[t - i - 1];
                }
            }
            for (i, c) in self.ma.iter().enumerate() {
                if t > i {
                    now -= c * w[t - i - 1];
                }
            }
            w.push(now);
        }
        w
    }
}
