//! Whether a finer grid follows a smooth border or a detail of it.

use crate::borders::Grid;

/// Share of what knots between those of a coarse grid gain that no smooth curve through the coarse ones foretells.
///
/// ```text
/// Σ (f(v) − cubic(v))² / Σ (f(v) − linear(v))²   over the knots between
/// ```
///
/// `cubic` is Lagrange's polynomial through the two coarse knots on either side of `v`, three of them beside an end. Linear
/// interpolation misses a smooth border by the square of the cell's width, the polynomial by its fourth power; of a ripple as short
/// as two cells neither knows anything.
pub(super) fn roughness(coarse: &Grid, fine: &Grid, f: &[f64]) -> f64 {
    let (mut unforetold, mut all) = (0.0, 0.0);
    for side in 0..2 {
        let offset = side * fine.knots[0].len();
        let value = |v: f64| offset + fine.knots[side].partition_point(|&k| k < v);
        let known: Vec<(f64, f64)> = coarse.knots[side].iter().map(|&v| (v, f[value(v)])).collect();
        for (&v, &f) in fine.knots[side].iter().zip(&f[offset..]) {
            let right = known.partition_point(|k| k.0 < v);
            if right == 0 || right == known.len() || known[right].0 == v {
                continue;
            }
            let around = |reach: usize| &known[right.saturating_sub(reach)..(right + reach).min(known.len())];
            unforetold += (f - lagrange(around(2), v)).powi(2);
            all += (f - lagrange(around(1), v)).powi(2);
        }
    }
    if all > 0.0 { unforetold / all } else { 0.0 }
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
    fn a_smooth_border_is_foretold_and_a_ripple_is_not() {
        assert!(of(|v| v * v - 0.3 * v) < 1e-20);
        assert!(of(|v| (3.0 * (v - 0.5)).tanh()) < 0.05);
        assert!(of(|v| v + 0.1 * (62.0 * v).sin()) > 0.6);
        assert_eq!(of(|v| v), 0.0);
    }
}
