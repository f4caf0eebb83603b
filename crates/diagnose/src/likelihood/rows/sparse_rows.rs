//! Sparse rows.

/// Sparse rows, one a sample: indices and values.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    start: Vec<u32>,
    terms: Vec<(u32, f64)>,
}

impl Rows {
    pub(crate) fn with_capacity(samples: usize) -> Self {
        let mut start = Vec::with_capacity(samples + 1);
        start.push(0);
        Self { start, terms: Vec::with_capacity(2 * samples) }
    }

    pub(crate) fn push(&mut self, row: &[(u32, f64)], scale: f64) {
        self.extend(row, scale);
        self.end_row();
    }

    /// Adds terms to the row that is being written.
    pub(super) fn extend(&mut self, terms: &[(u32, f64)], scale: f64) {
        for &(i, x) in terms {
            if x != 0.0 {
                self.terms.push((i, x * scale));
            }
        }
    }

    pub(super) fn end_row(&mut self) {
        self.start.push(self.terms.len() as u32);
    }

    /// Non-zeros of row `t`.
    #[inline]
    pub(crate) fn row(&self, t: usize) -> &[(u32, f64)] {
        &self.terms[self.start[t] as usize..self.start[t + 1] as usize]
    }

    /// Whether each of `count` columns has a non-zero.
    pub(crate) fn touched(&self, count: usize) -> Vec<bool> {
        let mut touched = vec![false; count];
        self.terms.iter().for_each(|&(i, _)| touched[i as usize] = true);
        touched
    }

    /// `u(t)` for border values (and column coefficients) `f`.
    #[inline]
    pub(crate) fn dot(&self, t: usize, f: &[f64]) -> f64 {
        self.row(t).iter().map(|&(i, x)| x * f[i as usize]).sum()
    }

    /// `u` for border values (and column coefficients) `f`.
    pub(crate) fn times(&self, f: &[f64]) -> Vec<f64> {
        let mut rest = &self.terms[..];
        let of_row = |w: &[u32]| {
            let (row, later) = rest.split_at((w[1] - w[0]) as usize);
            rest = later;
            row.iter().map(|&(i, x)| x * f[i as usize]).sum()
        };
        self.start.windows(2).map(of_row).collect()
    }
}
