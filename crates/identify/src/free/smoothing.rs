//! An input without the noise of its sensor, as far as the samples beside each one show its motion.

use std::ops::Range;
use switchback_model::reversal::Branches;

/// Largest half-width of a window, samples.
const WIDEST: usize = 64;

/// The motion behind a noisy input: at every sample the value of a parabola fitted to its neighbours.
///
/// A window has `2h + 1` samples with `h = 1, 2, 4, …, 64`, and either none reaches over a reversal, so that corners are not rounded, or all may, which finds the
/// extreme of a smooth motion better. Chosen is what has the least expected squared error, for white noise of a known standard deviation
///
/// ```text
/// Σ(v − v̂)² + 2 sd² Σ ∂v̂/∂v − N sd²
/// ```
///
/// (C. L. Mallows, Technometrics 15 (1973), doi 10.1080/00401706.1973.10489103). With `h = 1` the input stays as it is.
pub(super) fn smoothed(v: &[f64], branches: &Branches, sd: f64) -> Vec<f64> {
    let whole = std::iter::once(0..v.len()).collect();
    let cuts: [Vec<Range<usize>>; 2] = [whole, stretches(branches)];
    let half_widths = std::iter::successors(Some(1), |h| Some(2 * h)).take_while(|&h| h <= WIDEST);
    let candidates = half_widths.flat_map(|h| cuts.iter().map(move |stretches| (h, stretches)));
    let candidates = candidates.map(|(h, stretches)| {
        let mut risk = 0.0;
        let mut smooth = Vec::with_capacity(v.len());
        for stretch in stretches {
            for t in stretch.clone() {
                let (value, own_weight) = parabola(v, stretch, t, h);
                risk += (v[t] - value).powi(2) + 2.0 * sd * sd * own_weight;
                smooth.push(value);
            }
        }
        (risk, smooth)
    });
    candidates.min_by(|x, y| x.0.total_cmp(&y.0)).map_or_else(|| v.to_vec(), |(_, smooth)| smooth)
}

/// Samples between reversals.
fn stretches(branches: &Branches) -> Vec<Range<usize>> {
    let mut first = 0;
    let lengths = branches.labels().chunk_by(|x, y| x == y).map(<[_]>::len);
    lengths
        .map(|length| {
            first += length;
            first - length..first
        })
        .collect()
}

/// Value at `t` of the parabola fitted to the samples of its window, and the weight of `v[t]` in it.
fn parabola(v: &[f64], stretch: &Range<usize>, t: usize, half_width: usize) -> (f64, f64) {
    let length = (2 * half_width + 1).min(stretch.len());
    if length <= 3 {
        return (v[t], 1.0);
    }
    let first = t.saturating_sub(half_width).clamp(stretch.start, stretch.end - length);
    // Polynomials that are orthogonal over the window: 1, x and x² − mean of x².
    let count = length as f64;
    let mean_square = (count * count - 1.0) / 12.0;
    let x = |s: usize| (s - first) as f64 - 0.5 * (count - 1.0);
    let (linear_norm, square_norm) =
        (count * mean_square, count * mean_square * (count * count - 4.0) / 15.0);
    let (mut constant, mut linear, mut square) = (0.0, 0.0, 0.0);
    for s in first..first + length {
        constant += v[s];
        linear += x(s) * v[s];
        square += (x(s) * x(s) - mean_square) * v[s];
    }
    let (here, bent) = (x(t), x(t) * x(t) - mean_square);
    let value = constant / count + linear * here / linear_norm + square * bent / square_norm;
    (value, 1.0 / count + here * here / linear_norm + bent * bent / square_norm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use switchback_model::reversal::ReversalRule;
    use switchback_noise::{StreamId, white_samples};

    /// A triangle with corners every 50 samples, of slope 0.02.
    fn triangle(samples: usize) -> Vec<f64> {
        let height = |t: usize| if t % 100 < 50 { t % 100 } else { 100 - t % 100 };
        (0..samples).map(|t| 0.02 * height(t) as f64).collect()
    }

    #[test]
    fn the_parabola_is_that_of_least_squares() {
        let v = white_samples(StreamId { seed: 3, experiment: 0, replicate: 0 }, 40);
        for (stretch, t, half_width) in [(5..35, 20, 4), (5..35, 6, 4), (5..35, 34, 4), (10..17, 12, 8)] {
            let length = (2 * half_width + 1).min(stretch.len());
            let first = (t - half_width.min(t)).clamp(stretch.start, stretch.end - length);
            let design = DMatrix::from_fn(length, 3, |i, k| {
                ((first + i) as f64 - t as f64).powi(i32::try_from(k).unwrap())
            });
            let pseudo_inverse = design.pseudo_inverse(1e-12).unwrap();
            let window = DVector::from_column_slice(&v[first..first + length]);
            let (value, own_weight) = parabola(&v, &stretch, t, half_width);
            assert!((value - pseudo_inverse.row(0).dot(&window.transpose())).abs() < 1e-9);
            assert!((own_weight - pseudo_inverse[(0, t - first)]).abs() < 1e-9);
        }
    }

    #[test]
    fn most_of_the_noise_goes_and_corners_stay() {
        let (clean, sd) = (triangle(2000), 0.004);
        let noise = white_samples(StreamId { seed: 1, experiment: 0, replicate: 0 }, clean.len());
        let noisy: Vec<f64> = clean.iter().zip(&noise).map(|(v, w)| v + sd * w).collect();
        let rule = ReversalRule { threshold: 6.0 * sd, ..ReversalRule::EXACT };
        let smooth = smoothed(&noisy, &Branches::of(&noisy, rule).unwrap(), sd);
        let rms = |range: &dyn Fn(usize) -> bool| {
            let missed = (0..clean.len()).filter(|&t| range(t)).map(|t| (smooth[t] - clean[t]).powi(2));
            (missed.clone().sum::<f64>() / missed.count() as f64).sqrt()
        };
        assert!(rms(&|_| true) < 0.6 * sd, "{} of {sd}", rms(&|_| true));
        assert!(rms(&|t| t % 50 == 0) < 1.2 * sd, "{} of {sd} at the corners", rms(&|t| t % 50 == 0));
    }

    #[test]
    fn an_input_without_noise_stays_as_it_is() {
        let clean: Vec<f64> = (0..500).map(|t| (0.3 * f64::from(t)).sin()).collect();
        let smooth = smoothed(&clean, &Branches::of(&clean, ReversalRule::EXACT).unwrap(), 0.0);
        assert!(clean.iter().zip(&smooth).all(|(x, z)| x == z));
    }
}
