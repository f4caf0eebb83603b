//! Derivatives of the innovations with respect to the linear parameters, one row a counted sample.
//!
//! ```text
//! ∂e(t)/∂aᵢ = x(t−i),  ∂e/∂bⱼ = −(taps ∗ ũ)(t−j),  ∂e/∂f = −Σ b̃ⱼ·rows(t−j)/den,  ∂e/∂d = −ψ(t);   ∂w = D/C·∂e
//! ```
//!
//! A hat function touches two border values, so rows are sparse unless a recursive filter spreads them.

mod dense;
mod sparse;

use self::dense::dense_rows;
pub(crate) use self::dense::filtered_rows;
use self::sparse::sparse_rows;
use crate::design::{Design, DesignTrack};
use crate::linear::Linear;
use crate::normal::Normal;
use crate::rows::Rows;
use crate::whitener::{LEAD, Whitener};

/// Weighted derivatives, all tracks one after the other.
#[derive(Debug, Clone)]
pub(crate) struct Jacobian {
    columns: usize,
    store: Store,
}

#[derive(Debug, Clone)]
enum Store {
    Sparse(Rows),
    /// Row-major.
    Dense(Vec<f64>),
}

impl Jacobian {
    /// The derivatives at `p`; each row times its weight.
    pub(crate) fn new(
        design: &Design,
        p: &Linear,
        whitener: &Whitener,
        weights: Option<&[Vec<f64>]>,
    ) -> Self {
        let columns = p.len();
        let parts = parts(design, weights);
        let store = if spreads(design, whitener) {
            let mut out = Vec::with_capacity(design.samples() * columns);
            for (track, weights) in parts {
                dense_rows((design, track), p, whitener, |t, row| {
                    let weight = weights.map_or(1.0, |w| w[t]);
                    out.extend(row.iter().map(|x| weight * x));
                });
            }
            Store::Dense(out)
        } else {
            let mut out = Rows::with_capacity(design.samples());
            for (track, weights) in parts {
                sparse_rows((design, track), p, whitener, weights, |row| out.push(row, 1.0));
            }
            Store::Sparse(out)
        };
        Self { columns, store }
    }

    /// `Σ x xᵀ` and `Σ x w` for weighted innovations `w`.
    pub(crate) fn normal(&self, w: &[f64]) -> Normal {
        let mut normal = Normal::new(self.columns);
        match &self.store {
            Store::Sparse(rows) => {
                for (t, &w) in w.iter().enumerate() {
                    normal.add_sparse(rows.row(t), w);
                }
            }
            Store::Dense(rows) => normal.add_dense(rows, self.columns, w),
        }
        normal
    }

    /// `Σ x·c` for a weighted column `c`; zeros of `c` cost a comparison.
    pub(crate) fn cross(&self, column: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.columns];
        for (t, &c) in column.iter().enumerate().filter(|(_, c)| **c != 0.0) {
            self.add_row(t, c, &mut out);
        }
        out
    }

    /// `sum += scale·row(t)`.
    pub(crate) fn add_row(&self, t: usize, scale: f64, sum: &mut [f64]) {
        match &self.store {
            Store::Sparse(rows) => {
                for &(i, x) in rows.row(t) {
                    sum[i as usize] += x * scale;
                }
            }
            Store::Dense(rows) => {
                let row = &rows[t * self.columns..(t + 1) * self.columns];
                for (o, x) in sum.iter_mut().zip(row) {
                    *o += x * scale;
                }
            }
        }
    }
}

/// `Σ x xᵀ` and `Σ x w` of the derivatives at `p` with the columns of `extra` appended, innovations `w`, everything weighted.
/// No row is kept.
pub(crate) fn normal_equations(
    design: &Design,
    p: &Linear,
    whitener: &Whitener,
    weights: Option<&[Vec<f64>]>,
    (w, extra): (&[f64], &[Vec<f64>]),
) -> Normal {
    let columns = p.len();
    let width = columns + extra.len();
    let mut normal = Normal::new(width);
    // Rows so far, and the first of them that is not yet in the equations.
    let (mut row_number, mut from) = (0, 0);
    let mut block: Vec<f64> = Vec::with_capacity(BLOCK * width);
    for (track, weights) in parts(design, weights) {
        if spreads(design, whitener) {
            dense_rows((design, track), p, whitener, |t, row| {
                let weight = weights.map_or(1.0, |w| w[t]);
                block.extend(row.iter().map(|x| weight * x));
                block.extend(extra.iter().map(|column| column[row_number]));
                row_number += 1;
                if row_number - from == BLOCK {
                    normal.add_dense(&block, width, &w[from..row_number]);
                    block.clear();
                    from = row_number;
                }
            });
        } else {
            sparse_rows((design, track), p, whitener, weights, |row| {
                let extra = extra.iter().enumerate();
                row.extend(extra.map(|(j, column)| ((columns + j) as u32, column[row_number])));
                normal.add_sparse(row, w[row_number]);
                row_number += 1;
            });
        }
    }
    if !block.is_empty() {
        normal.add_dense(&block, width, &w[from..row_number]);
    }
    normal
}

/// Dense rows taken at a time: few enough to stay near the processor.
const BLOCK: usize = 64;

/// Whether a recursive filter spreads the border features over whole rows.
fn spreads(design: &Design, whitener: &Whitener) -> bool {
    !design.poles.is_empty() || !whitener.ma.is_empty() || whitener.ar.len() > LEAD
}

/// Tracks with the weights of their counted samples.
fn parts<'a>(
    design: &'a Design,
    weights: Option<&'a [Vec<f64>]>,
) -> impl Iterator<Item = (&'a DesignTrack, Option<&'a [f64]>)> {
    design.tracks.iter().enumerate().map(move |(k, track)| (track, weights.map(|w| &w[k][..])))
}

/// `taps ∗ ũ`: what the coefficients of B multiply.
fn tapped(design: &Design, track: &DesignTrack, p: &Linear) -> Vec<f64> {
    let u = design.input(track, &p.f);
    if design.taps.len() == 1 && design.taps[0] == 1.0 {
        return u;
    }
    (0..u.len())
        .map(|t| design.taps.iter().enumerate().map(|(k, c)| c * u[t.saturating_sub(k)]).sum())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{
        Assembly, BorderColumn, Clock, EquationColumn, Resting, Transition, TransitionLaw,
    };
    use crate::campaign::{Criterion, Track};
    use crate::testing::small_campaign;

    /// Central differences of half the sum of squares.
    fn gradient_is_the_slope(normal: &Normal, p: &Linear, half_sum: impl Fn(&Linear) -> f64) {
        for i in 0..p.len() {
            let mut by = vec![0.0; p.len()];
            by[i] = 1.0;
            let h = 1e-5;
            let slope = (half_sum(&p.moved(&by, h)) - half_sum(&p.moved(&by, -h))) / (2.0 * h);
            let scale = normal.entry(i, i).max(1.0);
            assert!((slope - normal.gradient[i]).abs() < 1e-6 * scale, "{i}: {slope} {}", normal.gradient[i]);
        }
    }

    /// The oracle of the Jacobian under one step.
    fn check(assembly: &Assembly, p: &Linear) {
        let (campaign, grid) = small_campaign();
        let design = Design::new(&campaign, &grid, assembly, Track::is_fit);
        // Without output noise the whitening filter does not depend on the parameters.
        let whitener = Whitener::new(&assembly.noise, &p.a);
        let half_sum =
            |p: &Linear| 0.5 * design.innovations(p, &whitener).iter().flatten().map(|w| w * w).sum::<f64>();
        let innovations = design.innovations(p, &whitener).concat();
        let normal = normal_equations(&design, p, &whitener, None, (&innovations, &[]));
        gradient_is_the_slope(&normal, p, half_sum);
    }

    #[test]
    fn the_jacobian_of_a_simulation_agrees_with_differences() {
        let (campaign, grid) = small_campaign();
        let campaign = campaign.judged_by(Criterion::Simulation { share: 1.0 });
        let f: Vec<f64> = (0..grid.len()).map(|i| (i as f64 * 0.7).sin()).collect();
        let p = Linear { a: vec![-0.9, 0.3], b: vec![0.8, 0.3], f, d: Vec::new() };
        let design = Design::new(&campaign, &grid, &Assembly::default(), Track::is_fit);
        // Here the filter 1/A moves with the parameters.
        let errors = |p: &Linear| {
            let whitener = design.whitener(&Assembly::default().noise, &p.a);
            design.innovations(p, &whitener).concat()
        };
        let half_sum = |p: &Linear| 0.5 * errors(p).iter().map(|w| w * w).sum::<f64>();
        let whitener = design.whitener(&Assembly::default().noise, &p.a);
        let normal = normal_equations(&design, &p, &whitener, None, (&errors(&p), &[]));
        gradient_is_the_slope(&normal, &p, half_sum);
    }

    /// The oracle of the sparse rows: the dense ones.
    fn same_as_dense(assembly: &Assembly, p: &Linear) {
        let (campaign, grid) = small_campaign();
        let design = Design::new(&campaign, &grid, assembly, Track::is_fit);
        let whitener = Whitener::new(&assembly.noise, &p.a);
        let weights: Vec<Vec<f64>> = design
            .tracks
            .iter()
            .map(|t| (t.from..t.x.len()).map(|t| 0.5 + 0.1 * (t % 7) as f64).collect())
            .collect();
        let w = design.innovations(p, &whitener).concat();
        let sparse = Jacobian::new(&design, p, &whitener, Some(&weights)).normal(&w);
        let mut rows = Vec::new();
        for (track, weights) in design.tracks.iter().zip(&weights) {
            dense_rows((&design, track), p, &whitener, |t, row| {
                rows.extend(row.iter().map(|x| weights[t] * x));
            });
        }
        let dense = Jacobian { columns: p.len(), store: Store::Dense(rows) }.normal(&w);
        for i in 0..p.len() {
            assert!((sparse.gradient[i] - dense.gradient[i]).abs() < 1e-10);
            for j in i..p.len() {
                assert!((sparse.entry(i, j) - dense.entry(i, j)).abs() < 1e-10, "{i} {j}");
            }
        }
    }

    #[test]
    fn further_columns_are_appended() {
        let (campaign, grid) = small_campaign();
        let f: Vec<f64> = (0..grid.len()).map(|i| (i as f64 * 0.7).sin()).collect();
        let p = Linear { a: vec![-0.6, 0.2], b: vec![0.8, 0.3], f, d: Vec::new() };
        for pole in [None, Some(0.5)] {
            let mut assembly = Assembly::default();
            pole.iter().for_each(|p: &f64| assembly.filter(&[1.0 - p], &[1.0, -p]));
            let design = Design::new(&campaign, &grid, &assembly, Track::is_fit);
            let whitener = Whitener::default();
            let w = design.innovations(&p, &whitener).concat();
            let extra: Vec<f64> = (0..w.len()).map(|t| (t as f64 * 0.9).cos()).collect();
            let jacobian = Jacobian::new(&design, &p, &whitener, None);
            let (alone, cross) = (jacobian.normal(&w), jacobian.cross(&extra));
            let both = normal_equations(&design, &p, &whitener, None, (&w, &[extra]));
            for (i, x) in cross.iter().enumerate() {
                assert!((both.entry(i, p.len()) - x).abs() < 1e-10);
                assert!((both.gradient[i] - alone.gradient[i]).abs() < 1e-10);
                assert!((both.entry(i, i) - alone.entry(i, i)).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn the_jacobian_agrees_with_differences() {
        let (_, grid) = small_campaign();
        let f: Vec<f64> = (0..grid.len()).map(|i| (i as f64 * 0.7).sin()).collect();
        let plain = Linear { a: vec![-0.6, 0.2], b: vec![0.8, 0.3], f, d: Vec::new() };
        check(&Assembly::default(), &plain);

        let mut assembly = Assembly {
            delay: 1.4,
            transition: Some(Transition { length: 0.1, shape: 1.2, law: TransitionLaw::Offset }),
            border_columns: vec![BorderColumn::Speed {
                power: 1.0,
                scale: 0.1,
                while_resting: Resting::Held,
            }],
            equation_columns: vec![EquationColumn::Trend { clock: Clock::Record, degree: 1 }],
            ..Assembly::default()
        };
        assembly.noise.ar = vec![0.3, -0.2];
        let mut rich = plain;
        rich.f.push(0.3);
        rich.d.push(0.1);
        check(&assembly, &rich);
        same_as_dense(&assembly, &rich);

        assembly.filter(&[0.5], &[1.0, -0.5]);
        assembly.noise.ma = vec![-0.4];
        check(&assembly, &rich);
    }
}
