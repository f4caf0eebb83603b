//! The nominal model: `A`, `B` and two borders, identified from all fit records at once.

use std::collections::VecDeque;

use nalgebra::DMatrix;

use crate::error::DiagnoseError;
use crate::least_squares::dense_sums::DenseSums;
use crate::least_squares::normal::Normal;
use crate::likelihood::design::{Design, Linear, filtered_rows};
use crate::likelihood::engine::{Fit, FitContext, fit};
use crate::model::augmented::AugmentedModel;
use crate::nominal::knots::{first_grid, refine};
use crate::records::dataset::{Dataset, ScaledRecord};

/// Identifies the nominal model of a given order and places the border knots.
pub(crate) fn identify(dataset: &Dataset, order: usize) -> Result<Fit, DiagnoseError> {
    Ok(refine(dataset, first_fit(dataset, order)?, &|_| AugmentedModel::default()))
}

/// The nominal model of a given order on the first grid.
pub(crate) fn first_fit(dataset: &Dataset, order: usize) -> Result<Fit, DiagnoseError> {
    let grid = first_grid(dataset);
    let needed = 2 * (2 * order + grid.len());
    if dataset.fit_samples() < needed {
        return Err(DiagnoseError::TooShort {
            samples: dataset.fit_samples(),
            order,
            knots: grid.len(),
            needed,
        });
    }
    let design = Design::new(dataset, &grid, &AugmentedModel::default(), ScaledRecord::is_fit);
    let start = first_guess(&design, order)?;
    let context = FitContext { dataset, grid: &grid, known: Some(&design) };
    fit(context, &|_| AugmentedModel::default(), &[], &start, 12)
        .ok_or_else(|| DiagnoseError::Singular { reason: "the regression has no finite solution".into() })
}

/// Over-parameterised least squares `y(t) = −Σ aᵢ y(t−i) + Σ_ik g_ik h_k(t−i) + Σ d ψ(t)`, then the best rank one of `g`.
///
/// `h` are the hats of the borders and the columns beside them. The hats of a row sum to one, so each lag's `g` is known up to
/// a constant shared among lags: their part of the rows of `g` is centred before the decomposition. (Bai, Automatica 1998.)
pub(crate) fn first_guess(design: &Design, n: usize) -> Result<Linear, DiagnoseError> {
    design.pass_begins();
    let augmented = &design.augmented;
    let hats = design.grid.len();
    let k = hats + augmented.border_columns.len();
    let nb = n + augmented.extra_b;
    let columns = n + nb * k;
    let size = columns + augmented.equation_columns.len();
    let mut normal = Normal::new(size);
    // A recursive filter leaves few zeros in a row, and so does the memory of the errors.
    let is_dense = !design.poles.is_empty() || !augmented.noise.ar.is_empty();
    let mut sums = is_dense.then(|| DenseSums::new((0..size).collect()));
    let mut row = vec![0.0; size];
    for scaled in &design.scaled_records {
        let dense = (!design.poles.is_empty()).then(|| filtered_rows(design, scaled, k));
        // What the errors remember is taken from every term of the equation.
        let mut whitened = Remembering::new(&augmented.noise.ar);
        for t in scaled.from.saturating_sub(augmented.noise.ar.len()).max(n)..scaled.x.len() {
            let may_count = |masked: &[bool]| !masked[t - scaled.from];
            let counts = t >= scaled.from && scaled.mask.out.as_deref().is_none_or(may_count);
            if !counts && augmented.noise.ar.is_empty() {
                continue;
            }
            row.fill(0.0);
            for i in 0..n {
                row[i] = -scaled.x[t - i - 1];
            }
            for i in 0..nb {
                let block = &mut row[n + i * k..n + (i + 1) * k];
                for (lag, tap) in design.taps.iter().enumerate() {
                    let past = t.saturating_sub(i + 1 + lag);
                    match &dense {
                        Some(rows) => {
                            for (target, x) in block.iter_mut().zip(&rows[past * k..(past + 1) * k]) {
                                *target += tap * x;
                            }
                        }
                        None => {
                            for &(j, x) in scaled.rows.row(past) {
                                block[j as usize] += tap * x;
                            }
                        }
                    }
                }
            }
            for (&j, psi) in scaled.columns.numbers.iter().zip(scaled.columns.row(t)) {
                row[columns + j] = *psi;
            }
            let (row, x) = whitened.next(&row, scaled.x[t]);
            match &mut sums {
                Some(sums) if counts => sums.push(row, std::iter::empty(), x),
                None if counts => normal.add(row, x),
                _ => {}
            }
        }
    }
    if let Some(sums) = sums {
        sums.add_to(&mut normal);
    }
    let factor = normal.factor(1e-7).ok_or_else(|| DiagnoseError::Singular {
        reason: "the lagged outputs and border features are linearly dependent".into(),
    })?;
    let theta = factor.solve(&normal.gradient);
    let visited: Vec<bool> = (0..k).map(|j| normal.entry(n + j, n + j) > 1e-9).collect();
    let count = visited[..hats].iter().filter(|v| **v).count().max(1) as f64;
    let rows = (0..hats).map(|j| normal.entry(n + j, n + j)).sum::<f64>().max(1e-300);
    let size_of = |j: usize| (count * normal.entry(n + j, n + j) / rows).sqrt();
    let mut g = DMatrix::zeros(nb, k);
    for i in 0..nb {
        let block = &theta[n + i * k..n + (i + 1) * k];
        let of_hats = block[..hats].iter().zip(&visited).filter(|(_, v)| **v);
        let mean = of_hats.map(|(x, _)| x).sum::<f64>() / count;
        for j in 0..k {
            let level = if j < hats { mean } else { 0.0 };
            g[(i, j)] = if visited[j] { block[j] - level } else { 0.0 };
        }
    }
    // A column beside the borders counts by what it makes of the input, as a hat where it is one does.
    for (j, mut column) in g.column_iter_mut().enumerate().skip(hats) {
        column *= size_of(j);
    }
    let svd = g.svd(true, true);
    let (Some(u), Some(vt)) = (svd.u, svd.v_t) else {
        return Err(DiagnoseError::Singular { reason: "the border table has no leading component".into() });
    };
    let lead = svd.singular_values.iter().enumerate().max_by(|x, y| x.1.total_cmp(y.1)).map_or(0, |x| x.0);
    let b: Vec<f64> = (0..nb).map(|i| u[(i, lead)]).collect();
    let unscaled = |j: usize| if j < hats { 1.0 } else { 1.0 / size_of(j).max(1e-12) };
    let f: Vec<f64> = (0..k).map(|j| vt[(lead, j)] * svd.singular_values[lead] * unscaled(j)).collect();
    Ok(Linear { a: theta[..n].to_vec(), b, f, d: theta[columns..].to_vec() })
}

/// Filters the rows of a regression and their right-hand sides by `1 + d₁ q⁻¹ + …`.
struct Remembering<'a> {
    ar: &'a [f64],
    /// Rows and right-hand sides, the latest first.
    past: VecDeque<(Vec<f64>, f64)>,
    row: Vec<f64>,
}

impl<'a> Remembering<'a> {
    fn new(ar: &'a [f64]) -> Self {
        Self { ar, past: VecDeque::new(), row: Vec::new() }
    }

    fn next<'r>(&'r mut self, row: &'r [f64], x: f64) -> (&'r [f64], f64) {
        if self.ar.is_empty() {
            return (row, x);
        }
        let mut filtered = x;
        self.row.clear();
        self.row.extend_from_slice(row);
        for (d, (before, x)) in self.ar.iter().zip(&self.past) {
            self.row.iter_mut().zip(before).for_each(|(r, b)| *r += d * b);
            filtered += d * x;
        }
        self.past.push_front((row.to_vec(), x));
        self.past.truncate(self.ar.len());
        (&self.row, filtered)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::augmented::{BorderColumn, EquationColumn, Resting};
    use crate::testing::{noise_free, small_dataset};

    #[test]
    fn a_column_that_rules_the_input_is_found_with_the_dynamics() {
        let (dataset, grid) = small_dataset();
        let speed = BorderColumn::Speed { power: 1.0, scale: 0.01, while_resting: Resting::Zero };
        let augmented = AugmentedModel { border_columns: vec![speed], ..AugmentedModel::default() };
        let mut truth = Linear { a: vec![-0.9, 0.3], b: vec![0.8, 0.6], f: Vec::new(), d: Vec::new() };
        // Centred, as the guess is.
        truth.f = vec![-0.3, 0.0, 0.3, -0.2, -0.1, 0.1, 0.2, 2.0];
        let dataset = noise_free(dataset, &grid, &augmented, &truth);
        let design = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        let guess = first_guess(&design, 2).expect("a guess");
        for (guess, a) in guess.a.iter().zip(&truth.a) {
            assert!((guess - a).abs() < 1e-4, "{:?}", guess);
        }
        // Hats that the record hardly visits blur the rank.
        assert!((guess.b[1] / guess.b[0] - 0.75).abs() < 0.02, "{:?}", guess.b);
        let column = guess.f[7] * guess.b[0] / truth.b[0];
        assert!((column - 2.0).abs() < 0.05, "{column}");
    }

    /// The oracle: the equation's terms filtered one by one.
    #[test]
    fn rows_and_right_hand_sides_are_filtered_alike() {
        let signal = |k: f64| (0..12).map(|t| (t as f64 * k).sin()).collect::<Vec<f64>>();
        let (one, other, x) = (signal(0.7), signal(1.9), signal(0.3));
        let ar = [-1.2, 0.5, -0.1];
        let slow = |s: &[f64], t: usize| s[t] + (1..=ar.len()).map(|k| ar[k - 1] * s[t - k]).sum::<f64>();
        let mut filter = Remembering::new(&ar);
        for t in 0..12 {
            let terms = [one[t], other[t]];
            let (row, right) = filter.next(&terms, x[t]);
            if t >= ar.len() {
                assert!((row[0] - slow(&one, t)).abs() + (row[1] - slow(&other, t)).abs() < 1e-14);
                assert!((right - slow(&x, t)).abs() < 1e-14);
            }
        }
        assert_eq!(Remembering::new(&[]).next(&[1.0], 2.0), (&[1.0][..], 2.0));
    }

    #[test]
    fn a_slow_lag_is_found_with_what_it_began_with() {
        let (dataset, grid) = small_dataset();
        let mut augmented = AugmentedModel::default();
        augmented.filter(&[0.06], &[1.0, -0.94]);
        let decay = EquationColumn::Decay { scaled: 0, radius: 0.94, frequency: 0.0, sine: false };
        augmented.equation_columns.push(decay);
        let mut truth = Linear { a: vec![-0.9, 0.3], b: vec![0.8, 0.6], f: Vec::new(), d: vec![0.5] };
        truth.f = vec![-0.3, 0.0, 0.3, -0.2, -0.1, 0.1, 0.2];
        let dataset = noise_free(dataset, &grid, &augmented, &truth);
        let design = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        let guess = first_guess(&design, 2).expect("a guess");
        // Hats behind a lag are hardly distinguished: the damping of the solution shows in the third figure.
        for (found, a) in guess.a.iter().zip(&truth.a) {
            assert!((found - a).abs() < 5e-3, "{guess:?}");
        }
        assert!((guess.d[0] - 0.5).abs() < 0.01, "{guess:?}");
        assert!((guess.b[1] / guess.b[0] - 0.75).abs() < 0.05, "{guess:?}");
    }
}
