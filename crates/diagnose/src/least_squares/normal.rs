//! Normal equations accumulated from sparse rows, and their damped solution.

use nalgebra::{DMatrix, DVector};

/// `Σ x xᵀ` (upper triangle) and `Σ x w` over rows `x` with right-hand sides `w`.
#[derive(Debug, Clone)]
pub(crate) struct Normal {
    pub(crate) size: usize,
    /// Row-major, upper triangle filled.
    matrix: Vec<f64>,
    pub(crate) gradient: Vec<f64>,
    /// Room for a row.
    terms: Vec<(u32, f64)>,
}

impl Normal {
    pub(crate) fn new(size: usize) -> Self {
        Self {
            size,
            matrix: vec![0.0; size * size],
            gradient: vec![0.0; size],
            terms: Vec::with_capacity(size),
        }
    }

    /// Adds one row, mostly zeros.
    pub(crate) fn add(&mut self, row: &[f64], w: f64) {
        let mut terms = std::mem::take(&mut self.terms);
        terms.clear();
        terms.extend(row.iter().enumerate().filter(|(_, x)| **x != 0.0).map(|(i, x)| (i as u32, *x)));
        self.add_sparse(&terms, w);
        self.terms = terms;
    }

    /// Adds one sparse row, its indices increasing.
    pub(crate) fn add_sparse(&mut self, row: &[(u32, f64)], w: f64) {
        for (k, &(i, x)) in row.iter().enumerate() {
            let i = i as usize;
            self.gradient[i] += x * w;
            let target = &mut self.matrix[i * self.size..(i + 1) * self.size];
            for &(j, y) in &row[k..] {
                target[j as usize] += x * y;
            }
        }
    }

    /// Adds `weight·(row·θ)²` given the present `θ`: a prior.
    pub(crate) fn add_prior(&mut self, terms: &[(usize, f64)], weight: f64, present: &[f64]) {
        let value: f64 = terms.iter().map(|&(i, c)| c * present[i]).sum();
        for &(i, c) in terms {
            self.gradient[i] += weight * c * value;
        }
        self.hold(terms, weight);
    }

    /// Keeps a step from moving along a direction.
    pub(crate) fn hold(&mut self, terms: &[(usize, f64)], weight: f64) {
        for &(i, c) in terms {
            for &(j, d) in terms {
                if j >= i {
                    self.matrix[i * self.size + j] += weight * c * d;
                }
            }
        }
    }

    /// Adds sums over some parameters, increasing, with each other: row-major, `stride` from one row to the next, of which the lower
    /// triangle is not read.
    pub(crate) fn add_block(&mut self, parameters: &[usize], sums: &[f64], stride: usize) {
        for (i, &row) in parameters.iter().enumerate() {
            for (&column, sum) in parameters.iter().zip(&sums[i * stride..]).skip(i) {
                self.add_entry(row, column, *sum);
            }
        }
    }

    /// Adds to an entry of the symmetric matrix, `i ≤ j`.
    pub(crate) fn add_entry(&mut self, i: usize, j: usize, x: f64) {
        self.matrix[i * self.size + j] += x;
    }

    /// Sets an entry of the symmetric matrix.
    pub(crate) fn set(&mut self, i: usize, j: usize, x: f64) {
        self.matrix[i.min(j) * self.size + i.max(j)] = x;
    }

    /// The equations with all but the chosen parameters held.
    pub(crate) fn restricted(&self, chosen: impl Fn(usize) -> bool) -> Self {
        let mut out = self.clone();
        for i in 0..self.size {
            for j in i..self.size {
                if !chosen(i) || !chosen(j) {
                    out.set(i, j, if i == j { 1.0 } else { 0.0 });
                }
            }
            if !chosen(i) {
                out.gradient[i] = 0.0;
            }
        }
        out
    }

    /// The equations of the first parameters alone.
    pub(crate) fn leading(&self, count: usize) -> Self {
        let mut out = Self::new(count);
        for i in 0..count {
            out.gradient[i] = self.gradient[i];
            (i..count).for_each(|j| out.set(i, j, self.entry(i, j)));
        }
        out
    }

    /// What the solution takes from the sum of squares, `gᵀM⁻¹g`; nothing where there is none.
    pub(crate) fn gain(&self) -> f64 {
        let Some(factor) = self.factor(1e-9) else { return 0.0 };
        factor.solve(&self.gradient).iter().zip(&self.gradient).map(|(x, g)| x * g).sum()
    }

    /// Entry of the symmetric matrix.
    pub(crate) fn entry(&self, i: usize, j: usize) -> f64 {
        self.matrix[i.min(j) * self.size + i.max(j)]
    }

    /// Cholesky factor of the matrix with relative damping of its diagonal; `None` if it is not positive definite.
    pub(crate) fn factor(&self, damping: f64) -> Option<Factor> {
        let n = self.size;
        let scale: Vec<f64> = (0..n)
            .map(|i| {
                let d = self.entry(i, i);
                if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 }
            })
            .collect();
        let m = DMatrix::from_fn(n, n, |i, j| {
            let x = self.entry(i, j) * scale[i] * scale[j];
            if i == j { x + damping + 1e-12 } else { x }
        });
        Some(Factor { cholesky: m.cholesky()?, scale })
    }
}

/// A scaled Cholesky factor.
#[derive(Debug, Clone)]
pub(crate) struct Factor {
    cholesky: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    scale: Vec<f64>,
}

impl Factor {
    /// Solves `M x = g`.
    pub(crate) fn solve(&self, g: &[f64]) -> Vec<f64> {
        let rhs = DVector::from_iterator(g.len(), g.iter().zip(&self.scale).map(|(x, s)| x * s));
        let x = self.cholesky.solve(&rhs);
        x.iter().zip(&self.scale).map(|(x, s)| x * s).collect()
    }

    /// `gᵀ M⁻¹ g`, from half a solution.
    pub(crate) fn energy(&self, g: &[f64]) -> f64 {
        let mut half = DVector::from_iterator(g.len(), g.iter().zip(&self.scale).map(|(x, s)| x * s));
        self.cholesky.l_dirty().solve_lower_triangular_mut(&mut half);
        half.norm_squared()
    }

    /// Diagonal entry of `M⁻¹`.
    pub(crate) fn inverse_diagonal(&self, i: usize) -> f64 {
        let mut unit = vec![0.0; self.scale.len()];
        unit[i] = 1.0;
        self.energy(&unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_solution_gives_the_energy() {
        let mut n = Normal::new(3);
        for row in [[1.0, 0.2, 0.0], [0.3, -2.0, 0.5], [0.0, 0.7, 1.5], [0.4, 0.0, -0.6]] {
            n.add(&row, 1.0);
        }
        let factor = n.factor(1e-9).expect("determined");
        let g = [0.3, -1.0, 2.0];
        let slow: f64 = factor.solve(&g).iter().zip(g).map(|(x, g)| x * g).sum();
        assert!((factor.energy(&g) - slow).abs() < 1e-12 * slow);
    }

    #[test]
    fn rows_give_their_products() {
        let rows = [[1.0, 0.0, 0.0, 2.0, 0.0, 0.0], [0.5, 1.0, 3.0, -1.0, 0.2, 4.0]];
        let mut n = Normal::new(6);
        n.add(&rows[0], 1.0);
        n.add(&rows[1], -2.0);
        for i in 0..6 {
            let g: f64 = rows[0][i] - 2.0 * rows[1][i];
            assert!((n.gradient[i] - g).abs() < 1e-15);
            for j in 0..6 {
                let m: f64 = rows.iter().map(|r| r[i] * r[j]).sum();
                assert!((n.entry(i, j) - m).abs() < 1e-15);
            }
        }
    }
}
