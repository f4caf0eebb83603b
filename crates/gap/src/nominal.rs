//! The nominal model: `A`, `B` and two borders, identified from all fit records at once.

use nalgebra::DMatrix;

use crate::assembly::Assembly;
use crate::borders::Grid;
use crate::campaign::Campaign;
use crate::design::{Design, Linear, filtered_rows};
use crate::engine::{Fit, Ground, fit};
use crate::error::DiagnoseError;
use crate::knots::{first_grid, refine};
use crate::normal::Normal;

/// Identifies the nominal model of a given order and places the border knots.
pub(crate) fn identify(campaign: &Campaign, order: usize) -> Result<Fit, DiagnoseError> {
    Ok(refine(campaign, first_fit(campaign, order)?, &|_| Assembly::default()))
}

/// The nominal model of a given order on the first grid.
pub(crate) fn first_fit(campaign: &Campaign, order: usize) -> Result<Fit, DiagnoseError> {
    let grid = first_grid(campaign);
    let needed = 2 * (2 * order + grid.len());
    if campaign.fit_samples() < needed {
        return Err(DiagnoseError::TooShort {
            samples: campaign.fit_samples(),
            order,
            knots: grid.len(),
            needed,
        });
    }
    let start = first_guess(campaign, &grid, order, &Assembly::default())?;
    let ground = Ground { campaign, grid: &grid, known: None };
    fit(ground, &|_| Assembly::default(), &[], &start, 12)
        .ok_or_else(|| DiagnoseError::Singular { reason: "the regression has no finite solution".into() })
}

/// Over-parameterised least squares `y(t) = −Σ aᵢ y(t−i) + Σ_ik g_ik h_k(t−i)`, then the best rank one of `g`.
///
/// `h` are the hats of the borders and the columns beside them. The hats of a row sum to one, so each lag's `g` is known up to
/// a constant shared among lags: their part of the rows of `g` is centred before the decomposition. (Bai, Automatica 1998.)
pub(crate) fn first_guess(
    campaign: &Campaign,
    grid: &Grid,
    n: usize,
    assembly: &Assembly,
) -> Result<Linear, DiagnoseError> {
    let design = Design::new(campaign, grid, assembly, |t| t.is_fit());
    let hats = grid.len();
    let k = hats + assembly.border_columns.len();
    let nb = n + assembly.extra_b;
    let size = n + nb * k;
    let mut normal = Normal::new(size);
    let mut row = vec![0.0; size];
    for track in &design.tracks {
        let dense = (!design.poles.is_empty()).then(|| filtered_rows(&design, track, k));
        for t in track.from..track.x.len() {
            row.fill(0.0);
            for i in 0..n {
                row[i] = -track.x[t - i - 1];
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
                            for &(j, x) in track.rows.row(past) {
                                block[j as usize] += tap * x;
                            }
                        }
                    }
                }
            }
            normal.add(&row, track.x[t]);
        }
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
    Ok(Linear { a: theta[..n].to_vec(), b, f, d: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{BorderColumn, Resting};
    use crate::testing::{noise_free, small_campaign};

    #[test]
    fn a_column_that_rules_the_input_is_found_with_the_dynamics() {
        let (campaign, grid) = small_campaign();
        let speed = BorderColumn::Speed { power: 1.0, scale: 0.01, while_resting: Resting::Zero };
        let assembly = Assembly { border_columns: vec![speed], ..Assembly::default() };
        let mut truth = Linear { a: vec![-0.9, 0.3], b: vec![0.8, 0.6], f: Vec::new(), d: Vec::new() };
        // Centred, as the guess is.
        truth.f = vec![-0.3, 0.0, 0.3, -0.2, -0.1, 0.1, 0.2, 2.0];
        let campaign = noise_free(campaign, &grid, &assembly, &truth);
        let guess = first_guess(&campaign, &grid, 2, &assembly).expect("a guess");
        for (guess, a) in guess.a.iter().zip(&truth.a) {
            assert!((guess - a).abs() < 1e-4, "{:?}", guess);
        }
        // Hats that the record hardly visits blur the rank.
        assert!((guess.b[1] / guess.b[0] - 0.75).abs() < 0.02, "{:?}", guess.b);
        let column = guess.f[7] * guess.b[0] / truth.b[0];
        assert!((column - 2.0).abs() < 0.05, "{column}");
    }
}
