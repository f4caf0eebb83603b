//! The parameters that are linear or bilinear given the effects' own.

/// `a`, `b`, border values and disturbance coefficients.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Linear {
    pub(crate) a: Vec<f64>,
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
