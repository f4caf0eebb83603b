//! Standard errors of whatever is computed from sums over replicates.

/// Delete-one jackknife standard error from the leave-one-section-out values of a statistic.
///
/// ```text
/// se² = (g−1)/g · Σ_k (θ₍ₖ₎ − θ̄)²
/// ```
///
/// (Efron and Stein, Annals of Statistics 9, 1981.) The sections hold equally many replicates; the statistic may be any smooth function
/// of their sums, such as the slope of a fitted line over cells that share their noise. `None` for fewer than two values, or if one is not
/// finite.
///
/// ```
/// # use switchback_identify::statistics::jackknife_se;
/// // For a mean the jackknife is the usual standard error.
/// let x = [1.0, 2.0, 4.0, 9.0];
/// let leave_one_out: Vec<f64> = x.iter().map(|xi| (16.0 - xi) / 3.0).collect();
/// let usual = (x.iter().map(|xi: &f64| (xi - 4.0).powi(2)).sum::<f64>() / 12.0).sqrt();
/// assert!((jackknife_se(&leave_one_out).unwrap() - usual).abs() < 1e-12);
/// ```
pub fn jackknife_se(leave_one_out: &[f64]) -> Option<f64> {
    let g = leave_one_out.len() as f64;
    if g < 2.0 || leave_one_out.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let mean = leave_one_out.iter().sum::<f64>() / g;
    let squares: f64 = leave_one_out.iter().map(|x| (x - mean).powi(2)).sum();
    Some(((g - 1.0) / g * squares).sqrt())
}
