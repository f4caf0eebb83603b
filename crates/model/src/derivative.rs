//! Derivatives of a sampled signal, a sample being the unit of time.

/// Central differences of fourth order, whose relative error at `ω` radians a sample is `ω⁴/30`; of second order next to an end, one-sided at it.
///
/// B. Fornberg, Math. Comp. 51 (1988), doi 10.1090/S0025-5718-1988-0935077-0.
pub(crate) fn derivative(x: &[f64]) -> Vec<f64> {
    let of = |t: usize| match (t.min(x.len() - 1 - t), x.len()) {
        (_, 1) => 0.0,
        (0, _) if t == 0 => x[1] - x[0],
        (0, _) => x[t] - x[t - 1],
        (1, _) => 0.5 * (x[t + 1] - x[t - 1]),
        _ => (8.0 * (x[t + 1] - x[t - 1]) - (x[t + 2] - x[t - 2])) / 12.0,
    };
    (0..x.len()).map(of).collect()
}

/// Second differences of fourth order, whose relative error at `ω` radians a sample is `ω⁴/90`; of second order next to an end, and at it as there.
pub(crate) fn second_derivative(x: &[f64]) -> Vec<f64> {
    if x.len() < 3 {
        return vec![0.0; x.len()];
    }
    let of = |t: usize| {
        let t = t.clamp(1, x.len() - 2);
        let next = x[t + 1] - 2.0 * x[t] + x[t - 1];
        match t.min(x.len() - 1 - t) {
            1 => next,
            _ => (16.0 * next - (x[t + 2] - 2.0 * x[t] + x[t - 2])) / 12.0,
        }
    };
    (0..x.len()).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_a_sine_are_of_fourth_order() {
        for (w, bound) in [(0.1_f64, 0.1_f64.powi(4)), (0.4, 0.4_f64.powi(4))] {
            let x: Vec<f64> = (0..200).map(|t| (w * f64::from(t)).sin()).collect();
            let (first, second) = (derivative(&x), second_derivative(&x));
            for t in 2..198 {
                let (sin, cos) = (w * t as f64).sin_cos();
                assert!((first[t] - w * cos).abs() <= 1.01 * w * bound / 30.0, "{w} {t}");
                assert!((second[t] + w * w * sin).abs() <= 1.01 * w * w * bound / 90.0, "{w} {t}");
            }
            // At an end the error is of first order.
            for t in [0, 1, 198, 199] {
                let (sin, cos) = (w * t as f64).sin_cos();
                assert!((first[t] - w * cos).abs() <= w * w);
                assert!((second[t] + w * w * sin).abs() <= 1.5 * w.powi(3));
            }
        }
        assert_eq!((derivative(&[1.0]), derivative(&[1.0, 3.0])), (vec![0.0], vec![2.0, 2.0]));
        assert_eq!(second_derivative(&[1.0, 3.0]), [0.0, 0.0]);
    }
}
