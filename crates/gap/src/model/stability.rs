//! Whether what `A` describes dies out.

/// Whether all roots of `zⁿ + a₁zⁿ⁻¹ + …` lie inside the unit circle (Schur–Cohn recursion).
pub(crate) fn stable(a: &[f64]) -> bool {
    let mut p: Vec<f64> = std::iter::once(1.0).chain(a.iter().copied()).collect();
    while p.len() > 1 {
        let n = p.len() - 1;
        let k = p[n] / p[0];
        if k.abs() >= 1.0 {
            return false;
        }
        p = (0..n).map(|i| p[i] - k * p[n - i]).collect();
    }
    true
}

/// Largest radius of a pole with which a model still counts as a simulator.
const SLOWEST: f64 = 0.9995;

/// Whether all poles lie inside the unit circle by a margin.
pub(crate) fn settles(a: &[f64]) -> bool {
    let scaled: Vec<f64> = (1..).zip(a).map(|(i, a)| a / SLOWEST.powi(i)).collect();
    stable(&scaled)
}

#[cfg(test)]
mod tests {
    use super::stable;

    #[test]
    fn stability_is_that_of_the_roots() {
        assert!(stable(&[-1.2, 0.5]));
        assert!(!stable(&[-1.01]));
        assert!(!stable(&[-2.0, 1.01]));
        assert!(stable(&[0.99]));
    }
}
