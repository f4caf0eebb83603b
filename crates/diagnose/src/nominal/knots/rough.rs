//! Whether a finer grid follows a smooth border or a refinement of it.

use crate::model::borders::Grid;

/// Share of what knots between those of a coarse grid gain that no smooth curve through the coarse ones predicts.
///
/// ```text
/// Σ (f(v) − cubic(v))² / Σ (f(v) − linear(v))²   over the knots between
/// ```
///
/// `cubic` is Lagrange's polynomial through the two coarse knots on either side of `v`. Linear interpolation misses a smooth border
/// by the square of the cell's width, the polynomial by its fourth power; of a ripple as short as two cells neither knows anything.
/// In the cells at the ends it goes through three, and cannot show a bend all along the cell from a kink at its inner end, where a
/// loop that closes may have one: whichever of the two misses less counts there.
pub(super) fn roughness(coarse: &Grid, fine: &Grid, f: &[f64]) -> f64 {
    let (mut innovation_share, mut all) = (0.0, 0.0);
    for side in 0..2 {
        let offset = side * fine.knots[0].len();
        let knots: Vec<(f64, f64)> =
            fine.knots[side].iter().copied().zip(f[offset..].iter().copied()).collect();
        let known: Vec<(f64, f64)> =
            knots.iter().filter(|(v, _)| coarse.knots[side].contains(v)).copied().collect();
        // No polynomial goes across a jump.
        for known in known.chunk_by(|left, right| left.0 < right.0) {
            for right in 1..known.len() {
                let inside = knots.iter().filter(|(v, _)| *v > known[right - 1].0 && *v < known[right].0);
                let missed = |reach: usize| -> f64 {
                    let points = &known[right.saturating_sub(reach)..(right + reach).min(known.len())];
                    inside.clone().map(|&(v, f)| (f - lagrange(points, v)).powi(2)).sum()
                };
                let [linear, cubic] = [1, 2].map(missed);
                let is_end = right == 1 || right + 1 == known.len();
                innovation_share += if is_end { cubic.min(linear) } else { cubic };
                all += linear;
            }
        }
    }
    if all > 0.0 { innovation_share / all } else { 0.0 }
}

/// The polynomial through some points.
fn lagrange(points: &[(f64, f64)], at: f64) -> f64 {
    let weight = |i: usize| -> f64 {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, other)| (at - other.0) / (points[i].0 - other.0)).product()
    };
    points.iter().enumerate().map(|(i, point)| weight(i) * point.1).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(border: impl Fn(f64) -> f64) -> f64 {
        let even = |cells: usize| -> Vec<f64> { (0..=cells).map(|i| i as f64 / cells as f64).collect() };
        let [coarse, fine] = [10, 20].map(|cells| Grid { knots: [even(cells), even(cells)] });
        let f: Vec<f64> = fine.knots.concat().into_iter().map(border).collect();
        roughness(&coarse, &fine, &f)
    }

    #[test]
    fn a_smooth_border_is_forecast_and_a_ripple_is_not() {
        assert!(of(|v| v * v - 0.3 * v) < 1e-20);
        assert!(of(|v| (3.0 * (v - 0.5)).tanh()) < 0.05);
        assert!(of(|v| v + 0.1 * (62.0 * v).sin()) > 0.6);
        assert_eq!(of(|v| v), 0.0);
    }

    #[test]
    fn a_loop_that_closes_with_a_kink_is_forecast_and_a_jump_or_a_bump_is_not() {
        let closing = |v: f64| (v * v).max(0.2 * v - 0.01);
        assert!(of(closing) < 0.2);
        assert!(of(|v| if v < 0.42 { 0.0 } else { 1.0 }) > 0.9);
        assert!(of(|v| v * v + (0.05 - (v - 0.45_f64).abs()).max(0.0)) > 0.9);
    }
}
