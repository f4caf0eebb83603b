//! Score tests: what added columns would gain, without a re-fit.

use crate::normal::{Factor, Normal};

/// Score-test gains of added columns.
pub(crate) struct Gains {
    factor: Factor,
    base: usize,
    cross: Vec<Vec<f64>>,
    solved: Vec<Vec<f64>>,
    corner: Vec<Vec<f64>>,
    gradient: Vec<f64>,
    gradient_base: Vec<f64>,
    variance: f64,
}

impl Gains {
    /// Splits normal equations into `base` present parameters and the added columns.
    pub(crate) fn new(normal: &Normal, base: usize, variance: f64) -> Option<Self> {
        let added = normal.size - base;
        let factor = normal.leading(base).factor(1e-8)?;
        let cross: Vec<Vec<f64>> =
            (0..added).map(|j| (0..base).map(|i| normal.entry(i, base + j)).collect()).collect();
        let solved = cross.iter().map(|c: &Vec<f64>| factor.solve(c)).collect();
        let corner =
            (0..added).map(|i| (0..added).map(|j| normal.entry(base + i, base + j)).collect()).collect();
        Some(Self {
            factor,
            base,
            cross,
            solved,
            corner,
            gradient: normal.gradient[base..].to_vec(),
            gradient_base: normal.gradient[..base].to_vec(),
            variance,
        })
    }

    /// Approximate gain in deviance from adding these columns, `gᵀ S⁻¹ g / σ²` with `S` the Schur complement.
    pub(crate) fn of(&self, columns: &[usize]) -> f64 {
        let k = columns.len();
        let present = self.factor.solve(&self.gradient_base);
        let mut small = Normal::new(k);
        let mut g = vec![0.0; k];
        for (i, &c) in columns.iter().enumerate() {
            g[i] = self.gradient[c] - (0..self.base).map(|m| self.cross[c][m] * present[m]).sum::<f64>();
            for (j, &d) in columns.iter().enumerate().skip(i) {
                let s = self.corner[c][d]
                    - (0..self.base).map(|m| self.cross[c][m] * self.solved[d][m]).sum::<f64>();
                let floor = if i == j { 1e-9 * self.corner[c][c] } else { 0.0 };
                small.set(i, j, s.max(if i == j { floor } else { f64::NEG_INFINITY }));
            }
        }
        let Some(factor) = small.factor(1e-9) else { return 0.0 };
        let x = factor.solve(&g);
        x.iter().zip(&g).map(|(x, g)| x * g).sum::<f64>() / self.variance
    }
}
