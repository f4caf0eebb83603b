//! The recursion of `1/A(q⁻¹)`.

/// `x(t) ← x(t) − Σᵢ aᵢ x(t−i)` from the `n`-th sample on, `n` the number of coefficients; the first `n` samples are initial values.
///
/// ```
/// # use switchback_model::linear::recurse;
/// let mut x = [1.0, 0.0, 0.0, 2.0];
/// recurse(&[-0.5], &mut x);
/// assert_eq!(x, [1.0, 0.5, 0.25, 2.125]);
/// ```
pub fn recurse(a: &[f64], x: &mut [f64]) {
    match a.len() {
        0 => {}
        1 => of_order::<1>(a, x),
        2 => of_order::<2>(a, x),
        3 => of_order::<3>(a, x),
        4 => of_order::<4>(a, x),
        5 => of_order::<5>(a, x),
        6 => of_order::<6>(a, x),
        _ => of_any_order(a, x),
    }
}

/// The past stays in registers.
fn of_order<const N: usize>(a: &[f64], x: &mut [f64]) {
    if x.len() < N {
        return;
    }
    let a: [f64; N] = std::array::from_fn(|i| a[i]);
    let mut past: [f64; N] = std::array::from_fn(|i| x[N - 1 - i]);
    for x in &mut x[N..] {
        let mut now = *x;
        for i in 0..N {
            now -= a[i] * past[i];
        }
        past.copy_within(..N - 1, 1);
        past[0] = now;
        *x = now;
    }
}

fn of_any_order(a: &[f64], x: &mut [f64]) {
    for t in a.len()..x.len() {
        let (past, now) = x.split_at_mut(t);
        for (a, past) in a.iter().zip(past.iter().rev()) {
            now[0] -= a * past;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_has_the_bits_of_the_sum_over_lags() {
        let signal: Vec<f64> = (0..60).map(|t| (0.7 * f64::from(t)).sin()).collect();
        for order in 0..8 {
            let a: Vec<f64> = (0..order).map(|i| 0.3 / f64::from(i + 1) - 0.1).collect();
            let (mut fast, mut slow) = (signal.clone(), signal.clone());
            recurse(&a, &mut fast);
            of_any_order(&a, &mut slow);
            assert_eq!(fast, slow, "{order}");
            recurse(&a, &mut []);
        }
    }
}
