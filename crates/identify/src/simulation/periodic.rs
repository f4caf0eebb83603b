//! The periodic noise-free response.

use nalgebra::{DMatrix, DVector};
use switchback_model::linear::{LinearSystem, filter};

/// One period of the stationary response `z` of a system to an input `u` that repeats it for ever.
///
/// ```text
/// z(p) = −Σᵢ aᵢ z(p−i) + Σᵢ bᵢ u(p−i),   all phases modulo T
/// ```
///
/// Closed form: the `n` starting values solve `(I − Φ)x = r`, with `Φ` the free response and `r` the forced one over a period; no
/// transient is waited for. `u` holds one period, any `T ≥ 1`; returns `T` values, phase for phase.
///
/// # Panics
/// If `u` is empty.
pub fn periodic_response(system: &LinearSystem, u: &[f64]) -> Vec<f64> {
    let (n, period) = (system.order(), u.len());
    assert!(period > 0, "a period has at least one sample");
    // Whole periods until the lag window fits into the run.
    let repeats = n.div_ceil(period);
    let length = repeats * period;
    let wrapped: Vec<f64> = (0..length)
        .map(|t| (1..=n).map(|i| system.b()[i - 1] * u[(t + n * period - i) % period]).sum())
        .collect();
    let last = |y: &[f64]| DVector::from_fn(n, |i, _| y[length - 1 - i]);
    let forced = last(&filter(system.a(), &[], &wrapped, &wrapped, 0.0, 0.0));
    let free = DMatrix::from_columns(
        &(0..n)
            .map(|k| {
                // The free response to y(−1−k) = 1 is the forced one to −a_{i+k}, the terms that still see it.
                let kick: Vec<f64> =
                    (0..length).map(|t| -system.a().get(t + k).copied().unwrap_or(0.0)).collect();
                last(&filter(system.a(), &[], &kick, &kick, 0.0, 0.0))
            })
            .collect::<Vec<_>>(),
    );
    let start =
        (DMatrix::identity(n, n) - free).lu().solve(&forced).expect("a stable system forgets its start");
    let mut z: Vec<f64> = start.iter().rev().copied().collect();
    for p in 0..period {
        let past: f64 = system.a().iter().enumerate().map(|(i, a)| a * z[n + p - 1 - i]).sum();
        z.push(wrapped[p] - past);
    }
    z.split_off(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_long_run_settles_on_it(p in -0.9..0.9_f64, q in -0.9..0.9_f64, b in 0.1..2.0_f64, u in prop::collection::vec(-1.0..1.0_f64, 1..12)) {
            prop_assume!((0.3 * b + b).abs() > 0.01 && (0.3 + p).abs() > 1e-3 && (0.3 + q).abs() > 1e-3);
            let system = LinearSystem::new(vec![-(p + q), p * q], vec![b, 0.3 * b]).expect("valid");
            let period = u.len();
            let long: Vec<f64> = (0..period * 500).map(|t| u[t % period]).collect();
            let y = filter(system.a(), system.b(), &long, &[], 0.0, 0.0);
            let z = periodic_response(&system, &u);
            for (z, y) in z.iter().zip(&y[y.len() - period..]) {
                prop_assert!((z - y).abs() < 1e-9);
            }
        }
    }
}
