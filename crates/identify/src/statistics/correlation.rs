//! Correlation of residuals with their own past and with an input.

/// Correlation `r(k) = Σ_t x(t−k) y(t) / √(Σx² Σy²)` at the given lags, over several records, none of which follows on another.
///
/// Both are taken about their means over each record. Under the hypothesis that they have nothing to do with each other, and one of them is
/// white, `r(k)` is about normal with variance `1/N`. L. Ljung, "System Identification", 2nd ed. 1999, §16.6.
///
/// ```
/// # use switchback_identify::statistics::correlation;
/// // An output that is its input two samples ago.
/// let x: Vec<f64> = (0..300).map(|t: i32| f64::from(t * t * 7919 % 1009)).collect();
/// let y: Vec<f64> = (0..300).map(|t| if t < 2 { 500.0 } else { x[t - 2] }).collect();
/// assert!(correlation(&[(&x, &y)], &[2])[0] > 0.95);
/// ```
///
/// # Panics
/// If the two parts of a pair differ in length.
pub fn correlation(pairs: &[(&[f64], &[f64])], lags: &[isize]) -> Vec<f64> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let centred = |values: &[f64]| -> Vec<f64> {
        let mean = mean(values);
        values.iter().map(|x| x - mean).collect()
    };
    let pairs: Vec<(Vec<f64>, Vec<f64>)> = pairs
        .iter()
        .inspect(|(x, y)| assert_eq!(x.len(), y.len(), "one value of each a sample"))
        .map(|(x, y)| (centred(x), centred(y)))
        .collect();
    let products = |lag: isize| -> f64 {
        let (from_x, from_y) = ((-lag).max(0) as usize, lag.max(0) as usize);
        let one = |(x, y): &(Vec<f64>, Vec<f64>)| -> f64 {
            x.iter().skip(from_x).zip(y.iter().skip(from_y)).map(|(x, y)| x * y).sum()
        };
        pairs.iter().map(one).sum()
    };
    let squares =
        |values: &mut dyn Iterator<Item = &Vec<f64>>| -> f64 { values.flatten().map(|x| x * x).sum() };
    let of_x = squares(&mut pairs.iter().map(|(x, _)| x));
    let size = (of_x * squares(&mut pairs.iter().map(|(_, y)| y))).sqrt();
    lags.iter().map(|&lag| if size > 0.0 { products(lag) / size } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn white(seed: u64, count: usize) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        (0..count).map(|_| rng.random_range(-1.0..1.0)).collect()
    }

    #[test]
    fn white_noise_stays_within_its_bounds_and_an_autoregression_decays() {
        let w = white(1, 4000);
        let lags: Vec<isize> = (0..=20).collect();
        let own = correlation(&[(&w, &w)], &lags);
        assert!((own[0] - 1.0).abs() < 1e-12);
        assert!(own[1..].iter().all(|r| r.abs() < 4.0 / 4000f64.sqrt()), "{own:?}");
        let mut ar = vec![0.0; w.len()];
        (1..w.len()).for_each(|t| ar[t] = 0.7 * ar[t - 1] + w[t]);
        let own = correlation(&[(&ar, &ar)], &lags);
        // ρ(k) = 0.7ᵏ.
        (1..4).for_each(|k| assert!((own[k] - 0.7f64.powi(k as i32)).abs() < 0.06, "{k}: {}", own[k]));
    }

    #[test]
    fn a_lag_is_found_on_its_side_and_records_do_not_follow_on_each_other() {
        let x = white(2, 500);
        let late: Vec<f64> = (0..500).map(|t| if t < 3 { 0.0 } else { x[t - 3] }).collect();
        let r = correlation(&[(&x[..250], &late[..250]), (&x[250..], &late[250..])], &[-3, 3]);
        assert!(r[0].abs() < 0.2 && r[1] > 0.95, "{r:?}");
    }

    #[test]
    fn records_at_different_levels_are_not_correlated_by_these() {
        let (x, y) = (white(3, 600), white(4, 600));
        let up = |values: &[f64]| values.iter().map(|x| x + 50.0).collect::<Vec<f64>>();
        let r = correlation(&[(&x[..300], &y[..300]), (&up(&x[300..]), &up(&y[300..]))], &[0])[0];
        assert!(r.abs() < 4.0 / 600f64.sqrt(), "{r}");
    }

    #[test]
    fn what_does_not_move_is_correlated_with_nothing() {
        assert_eq!(correlation(&[(&[2.0; 5], &[1.0; 5])], &[0, 9]), [0.0, 0.0]);
        assert_eq!(correlation(&[], &[0]), [0.0]);
    }
}
