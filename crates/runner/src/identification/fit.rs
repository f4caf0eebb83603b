//! The fit figure.

/// How much of a measured output a simulation explains.
///
/// ```text
/// 100·(1 − ‖y − ŷ‖ / ‖y − ȳ‖)
/// ```
///
/// 100 is perfect, 0 is no better than the record's mean, and below 0 is worse. NaN where `y` never moves, since there is
/// nothing to explain.
///
/// # Panics
/// If the lengths differ.
///
/// ```
/// # use switchback::identification::fit_percent;
/// assert_eq!(fit_percent(&[0.0, 2.0], &[0.0, 2.0]), 100.0);
/// assert_eq!(fit_percent(&[0.0, 2.0], &[1.0, 1.0]), 0.0);
/// ```
pub fn fit_percent(measured: &[f64], simulated: &[f64]) -> f64 {
    assert_eq!(measured.len(), simulated.len(), "a simulation has one value a sample");
    let mean = measured.iter().sum::<f64>() / measured.len() as f64;
    let missed: f64 = measured.iter().zip(simulated).map(|(y, s)| (y - s).powi(2)).sum();
    let there: f64 = measured.iter().map(|y| (y - mean).powi(2)).sum();
    if there > 0.0 { 100.0 * (1.0 - (missed / there).sqrt()) } else { f64::NAN }
}
