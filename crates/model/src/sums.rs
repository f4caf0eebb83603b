//! Sums over samples.

/// Sums kept apart, so that no addition waits for the one before.
const APART: usize = 8;

/// `Σ x·y` over the shorter of two signals.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let count = x.len().min(y.len());
    let ((x, last_x), (y, last_y)) = (x[..count].as_chunks::<APART>(), y[..count].as_chunks::<APART>());
    let mut sums = [0.0; APART];
    for (x, y) in x.iter().zip(y) {
        for k in 0..APART {
            sums[k] += x[k] * y[k];
        }
    }
    let last: f64 = last_x.iter().zip(last_y).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + last
}

/// `Σ x²`.
pub fn energy(x: &[f64]) -> f64 {
    dot(x, x)
}

/// Samples of a piece, at least.
const LEAST_PIECE: usize = 5;

/// Mean of a signal over so many equal pieces, two at least, and its standard error by the scatter of their means; what fills no piece is left out. None where pieces
/// would be too short.
pub fn mean_over_pieces(x: &[f64], pieces: usize) -> Option<(f64, f64)> {
    let length = x.len() / pieces;
    if length < LEAST_PIECE {
        return None;
    }
    let means = || x.chunks_exact(length).map(|piece| piece.iter().sum::<f64>() / length as f64);
    let count = means().count() as f64;
    let mean = means().sum::<f64>() / count;
    let variance = means().map(|m| (m - mean).powi(2)).sum::<f64>() / (count - 1.0);
    Some((mean, (variance / count).sqrt()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_mean_has_the_error_of_its_pieces() {
        let x: Vec<f64> = (0..40).map(|t| if t < 20 { 1.0 } else { 3.0 }).collect();
        assert_eq!(mean_over_pieces(&x, 2), Some((2.0, 1.0)));
        assert_eq!(mean_over_pieces(&x, 9), None);
    }

    proptest! {
        #[test]
        fn sums_apart_are_the_sum(x in prop::collection::vec(-1e3..1e3_f64, 0..100), more in 0..20_usize) {
            let y: Vec<f64> = x.iter().rev().map(|x| x + 0.5).chain(vec![1e9; more]).collect();
            let slow: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
            prop_assert!((dot(&x, &y) - slow).abs() <= 1e-7);
            prop_assert_eq!(dot(&x, &y), dot(&y, &x));
        }
    }
}
