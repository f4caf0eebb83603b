//! A straight line through points of unequal weight.

/// `y = intercept + slope·x`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// `y` at `x = 0`.
    pub intercept: f64,
    /// Change of `y` a unit of `x`.
    pub slope: f64,
}

/// Weighted least-squares line through `(x, y, weight)`; `None` if fewer than two different `x` carry weight.
///
/// ```
/// # use switchback_identify::statistics::weighted_line;
/// let line = weighted_line(&[(0.0, 1.0, 1.0), (1.0, 3.0, 2.0), (2.0, 5.0, 1.0)]).unwrap();
/// assert!((line.slope - 2.0).abs() < 1e-12 && (line.intercept - 1.0).abs() < 1e-12);
/// ```
pub fn weighted_line(points: &[(f64, f64, f64)]) -> Option<Line> {
    let total: f64 = points.iter().map(|p| p.2).sum();
    let mean_x = points.iter().map(|p| p.2 * p.0).sum::<f64>() / total;
    let mean_y = points.iter().map(|p| p.2 * p.1).sum::<f64>() / total;
    let spread: f64 = points.iter().map(|p| p.2 * (p.0 - mean_x).powi(2)).sum();
    let slope = points.iter().map(|p| p.2 * (p.0 - mean_x) * (p.1 - mean_y)).sum::<f64>() / spread;
    let line = Line { intercept: mean_y - slope * mean_x, slope };
    (line.slope.is_finite() && line.intercept.is_finite()).then_some(line)
}
