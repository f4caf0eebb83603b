//! A signal that arrives later, or earlier, by any share of a sample.

/// `x(t − d)`: exact for whole `d`, between samples by the cubic through four neighbours (Lagrange); beyond the ends the signal keeps its end values.
///
/// ```
/// # use switchback_model::system::delayed;
/// assert_eq!(delayed(&[1.0, 2.0, 3.0, 5.0], 1.0), [1.0, 1.0, 2.0, 3.0]);
/// assert_eq!(delayed(&[1.0, 2.0, 3.0, 5.0], -1.0), [2.0, 3.0, 5.0, 5.0]);
/// // A parabola passes exactly.
/// let x: Vec<f64> = (0..9).map(|t| f64::from(t * t)).collect();
/// assert!((delayed(&x, 0.5)[4] - 3.5 * 3.5).abs() < 1e-12);
/// ```
pub fn delayed(x: &[f64], d: f64) -> Vec<f64> {
    let whole = d.floor();
    let s = d - whole;
    let last = x.len() as f64 - 1.0;
    let at = |t: usize, more: f64| x[(t as f64 - whole - more).clamp(0.0, last) as usize];
    if s == 0.0 {
        return (0..x.len()).map(|t| at(t, 0.0)).collect();
    }
    // Nodes at −1, 0, 1, 2 samples back from the whole part.
    let weights = [
        -s * (s - 1.0) * (s - 2.0) / 6.0,
        (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0,
        -(s + 1.0) * s * (s - 2.0) / 2.0,
        (s + 1.0) * s * (s - 1.0) / 6.0,
    ];
    (0..x.len()).map(|t| weights.iter().zip([-1.0, 0.0, 1.0, 2.0]).map(|(w, k)| w * at(t, k)).sum()).collect()
}
