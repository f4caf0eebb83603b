//! Scales of columns by their quantiles.

use switchback_diagnose::posterior::Standard;

/// Median and the spread from the 10 % to the 90 % quantile over that of a normal variable; a little of the standard deviation keeps columns
/// that are mostly constant in bounds.
pub(super) fn standard(values: &[Vec<f64>]) -> Standard {
    let mut standard = Standard { centre: Vec::new(), scale: Vec::new() };
    for column in values {
        let mut sorted = column.clone();
        sorted.sort_by(f64::total_cmp);
        let quantile = |q: f64| sorted[((sorted.len() - 1) as f64 * q).round() as usize];
        let mean = column.iter().sum::<f64>() / column.len() as f64;
        let sd = (column.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / column.len() as f64).sqrt();
        standard.centre.push(quantile(0.5).clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32);
        let scale = (quantile(0.9) - quantile(0.1)) / 2.563 + 1e-3 * sd;
        standard.scale.push(if scale > 1e-30 { scale.min(f64::from(f32::MAX)) as f32 } else { 1.0 });
    }
    standard
}
