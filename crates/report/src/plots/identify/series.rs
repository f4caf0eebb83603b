//! Long series thinned for drawing.

/// At most about `columns` pairs of points that draw the same picture as the whole series: the least and the greatest
/// value of each stretch, in their order, so that no peak is lost.
pub(crate) fn thinned(points: &[(f64, f64)], columns: usize) -> Vec<(f64, f64)> {
    if points.len() <= 2 * columns {
        return points.to_vec();
    }
    let stretch = points.len().div_ceil(columns);
    points
        .chunks(stretch)
        .flat_map(|chunk| {
            let least = (0..chunk.len()).min_by(|&i, &j| chunk[i].1.total_cmp(&chunk[j].1)).unwrap_or(0);
            let greatest = (0..chunk.len()).max_by(|&i, &j| chunk[i].1.total_cmp(&chunk[j].1)).unwrap_or(0);
            [chunk[least.min(greatest)], chunk[least.max(greatest)]]
        })
        .collect()
}

/// Where a window of `width` samples misses most: the start of the one with the greatest sum of squared errors.
pub(crate) fn worst_window(errors: &[f64], width: usize) -> usize {
    let mut sum: f64 = errors.iter().take(width).map(|e| e * e).sum();
    let (mut worst, mut start) = (sum, 0);
    for last in width..errors.len() {
        sum += errors[last] * errors[last] - errors[last - width] * errors[last - width];
        if sum > worst {
            (worst, start) = (sum, last + 1 - width);
        }
    }
    start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_peaks_and_the_order() {
        let mut points: Vec<_> = (0..10_000).map(|k| (f64::from(k), 0.0)).collect();
        points[1234].1 = 7.0;
        points[8765].1 = -3.0;
        let thin = thinned(&points, 100);
        assert!(thin.len() <= 200);
        assert!(thin.contains(&(1234.0, 7.0)) && thin.contains(&(8765.0, -3.0)));
        assert!(thin.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn the_worst_window_holds_the_error() {
        let mut errors = vec![0.1; 1000];
        errors[700] = 5.0;
        let start = worst_window(&errors, 50);
        assert!((651..=700).contains(&start));
        assert_eq!(worst_window(&errors[..20], 50), 0);
    }
}
