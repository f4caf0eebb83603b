//! Facts about `A(q⁻¹)` and `B(q⁻¹)` that decide whether a pair makes an identifiable system.

use nalgebra::DMatrix;

/// Whether `A = 1 + a₁q⁻¹ + … + aₙq⁻ⁿ` is stable: every root of `qⁿA` lies strictly inside the unit circle.
///
/// Step-down (Schur–Cohn) recursion: stable if and only if every reflection coefficient has modulus below one.
/// Needs no roots, costs `O(n²)`. `a` holds `a₁…aₙ`.
///
/// ```
/// # use switchback_model::linear::is_stable;
/// assert!(is_stable(&[-1.5, 0.7]));
/// assert!(!is_stable(&[-2.0, 1.0])); // a double root on the circle
/// ```
pub fn is_stable(a: &[f64]) -> bool {
    let mut a = a.to_vec();
    while let Some(k) = a.pop() {
        if k.is_nan() || k.abs() >= 1.0 {
            return false;
        }
        let m = a.len();
        let scale = 1.0 - k * k;
        a = (0..m).map(|i| (a[i] - k * a[m - 1 - i]) / scale).collect();
    }
    true
}

/// Largest modulus among the roots of `qⁿ + a₁qⁿ⁻¹ + … + aₙ`, the slowest pole.
///
/// Bisection on the radius `r` for which `A(r·q)` turns stable, so it is exact for multiple roots too, where
/// an eigenvalue solver loses half its digits. Accurate to 1e-12. `a` holds `a₁…aₙ`.
pub fn spectral_radius(a: &[f64]) -> f64 {
    // Cauchy's bound on the roots.
    let mut high = 1.0 + a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut low = 0.0;
    while high - low > 1e-12 * high.max(1.0) {
        let r = 0.5 * (low + high);
        let scaled: Vec<f64> = a.iter().enumerate().map(|(i, x)| x / r.powi(i as i32 + 1)).collect();
        if is_stable(&scaled) {
            high = r;
        } else {
            low = r;
        }
    }
    high
}

/// Samples until a free response of `1/A` has fallen below `tolerance` of its start for good.
///
/// The impulse response of `1/A` is bounded by `c·ρᵗ` with a polynomial factor for multiple poles; the bound used is its
/// actual decay: the response is run until `n` consecutive values, weighted by the peak so far, stay below
/// `tolerance·(1 − ρ)`, where `ρ` is the slowest pole. At least `n`, and at most 10⁷; none for `A = 1`.
///
/// # Panics
/// If `A` is unstable.
pub fn settling_samples(a: &[f64], tolerance: f64) -> usize {
    assert!(is_stable(a), "an unstable system never settles");
    let n = a.len();
    if n == 0 {
        return 0;
    }
    let rho = spectral_radius(a).min(1.0 - 1e-9);
    let mut recent = vec![0.0; n];
    recent[0] = 1.0;
    let mut peak: f64 = 1.0;
    for t in 1..10_000_000 {
        let now: f64 = -a.iter().zip(&recent).map(|(ai, y)| ai * y).sum::<f64>();
        recent.rotate_right(1);
        recent[0] = now;
        peak = peak.max(now.abs());
        if t >= n && recent.iter().all(|y| y.abs() <= tolerance * (1.0 - rho) * peak) {
            return t;
        }
    }
    10_000_000
}

/// How far `A` and `B` are from sharing a root: smallest over largest singular value of their Sylvester matrix.
///
/// `qⁿA(q⁻¹) = qⁿ + a₁qⁿ⁻¹ + … + aₙ` and `qⁿB(q⁻¹) = b₁qⁿ⁻¹ + … + bₙ` are coprime if and only if the value is positive.
/// Returns a number in `[0, 1]`.
///
/// # Panics
/// If the lengths differ or are zero.
pub fn relative_coprimeness(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len();
    assert!(n > 0 && b.len() == n, "A and B need the same order, at least 1");
    let numerator: Vec<f64> = std::iter::once(0.0).chain(b.iter().copied()).collect();
    let denominator: Vec<f64> = std::iter::once(1.0).chain(a.iter().copied()).collect();
    let sylvester = DMatrix::from_fn(2 * n, 2 * n, |row, column| {
        let (shift, poly) = if row < n { (row, &denominator) } else { (row - n, &numerator) };
        column.checked_sub(shift).and_then(|k| poly.get(k)).copied().unwrap_or(0.0)
    });
    let singular = sylvester.singular_values();
    singular.min() / singular.max()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// `∏ (1 − pₖq⁻¹)` over real poles, as `a₁…aₙ`.
    fn from_poles(poles: &[f64]) -> Vec<f64> {
        let mut c = vec![1.0];
        for p in poles {
            c.push(0.0);
            for i in (1..c.len()).rev() {
                c[i] -= p * c[i - 1];
            }
        }
        c.split_off(1)
    }

    proptest! {
        #[test]
        fn stability_and_radius_follow_the_poles(poles in prop::collection::vec(-1.4..1.4_f64, 1..5)) {
            let largest = poles.iter().fold(0.0_f64, |m, p| m.max(p.abs()));
            prop_assume!((largest - 1.0).abs() > 1e-6);
            let a = from_poles(&poles);
            prop_assert_eq!(is_stable(&a), largest < 1.0);
            // Nearly multiple poles cost digits in the coefficients themselves, not in the recursion.
            prop_assert!((spectral_radius(&a) - largest).abs() < 1e-3);
        }

        #[test]
        fn a_shared_root_is_seen(p in -0.9..0.9_f64, q in -0.9..0.9_f64, r in -0.9..0.9_f64) {
            prop_assume!((p - q).abs() > 0.05 && (r - p).abs() > 0.05 && (r - q).abs() > 0.05);
            let a = from_poles(&[p, q]);
            prop_assert!(relative_coprimeness(&a, &[1.0, -p]) < 1e-12);
            prop_assert!(relative_coprimeness(&a, &[1.0, -r]) > 1e-5);
        }
    }

    #[test]
    fn settling_is_the_decay_of_the_slowest_pole() {
        let t = settling_samples(&[-0.9], 1e-6);
        assert!(0.9_f64.powi(t as i32) <= 1e-6 && 0.9_f64.powi(t as i32) >= 1e-8);
        assert_eq!(settling_samples(&[], 1e-6), 0);
    }
}
