//! What noise on the input does to the working point.

use libm::erfc;

use super::sparse_rows::Rows;
use crate::model::borders::{Grid, side};
use crate::records::dataset::ScaledRecord;

/// Probability that the noisy position rises: `P(step + n₁ − n₀ > 0)`, both noises normal with standard deviation `jitter`.
pub(super) fn ascending(step: f64, jitter: f64) -> f64 {
    0.5 * erfc(-0.5 * step / jitter)
}

/// How `u` answers to a small change of `v`, as rows: per unit of `v` while moving (over a fiftieth of the stroke, so
/// that a jump counts as a steep slope), and by a switch to the other border while resting, or at any
/// time where noise on the position of standard deviation `jitter` switches branches.
pub(crate) fn sensitivity_rows(scaled: &ScaledRecord, grid: &Grid, jitter: f64) -> [Rows; 2] {
    const HALF: f64 = 0.01;
    let mut moving = Rows::with_capacity(scaled.v.len());
    let mut resting = Rows::with_capacity(scaled.v.len());
    let (mut slope, mut gap) = (Vec::new(), Vec::new());
    for (m, &v) in scaled.moves.iter().zip(&scaled.v) {
        slope.clear();
        gap.clear();
        let border = side(m.branch);
        let spread = if jitter > 0.0 {
            let p = ascending(m.step, jitter);
            (p * (1.0 - p)).sqrt()
        } else {
            f64::from(u8::from(!m.moves))
        };
        if m.moves || jitter > 0.0 {
            slope.extend(grid.hat(border, v + HALF).map(|(i, w)| (i as u32, w / (2.0 * HALF))));
            slope.extend(grid.hat(border, v - HALF).map(|(i, w)| (i as u32, -w / (2.0 * HALF))));
        }
        if spread > 0.0 {
            gap.extend(grid.hat(1, v).map(|(i, w)| (i as u32, spread * w)));
            gap.extend(grid.hat(0, v).map(|(i, w)| (i as u32, -spread * w)));
        }
        moving.push(&slope, 1.0);
        resting.push(&gap, 1.0);
    }
    [moving, resting]
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use statrs::distribution::{ContinuousCDF, Normal};

    use super::*;

    #[test]
    fn the_noisy_position_rises_as_often_as_draws_do() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let normal = Normal::new(0.0, 0.02).unwrap();
        let mut draw = || normal.inverse_cdf(rng.random::<f64>());
        for step in [-0.05, -0.01, 0.0, 0.02] {
            let rises = (0..20_000).filter(|_| step + draw() - draw() > 0.0).count() as f64 / 20_000.0;
            // Four standard errors of a share.
            assert!((rises - ascending(step, 0.02)).abs() < 0.015, "{step}: {rises}");
        }
    }
}
