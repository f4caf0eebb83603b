//! Long series drawn with fewer points.

use crate::plots::identify::series::{thinned, worst_window};
use std::ops::Range;
use switchback_io::model::RecordSeries;

/// Columns of a record that is drawn over time: twice as many points stay, so that records of 3000 samples lose none.
const COLUMNS: usize = 1500;

/// The same picture with fewer points: the least and the greatest value of each stretch.
pub(super) fn line(t: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    let points: Vec<(f64, f64)> = t.iter().copied().zip(y.iter().copied()).collect();
    thinned(&points, COLUMNS)
}

/// A band that holds that of every sample.
pub(super) fn band(t: &[f64], y: &[f64], half: &[f64]) -> Vec<(f64, f64, f64)> {
    let stretch = t.len().div_ceil(COLUMNS).max(1);
    let of = |start: usize| {
        let samples = start..(start + stretch).min(t.len());
        let low = samples.clone().map(|k| y[k] - half[k]).fold(f64::INFINITY, f64::min);
        let high = samples.map(|k| y[k] + half[k]).fold(f64::NEG_INFINITY, f64::max);
        (t[start], low, high)
    };
    (0..t.len()).step_by(stretch).map(of).collect()
}

/// The samples of a record that a loop is drawn of: all, or those where the first run misses most.
pub(super) fn window(record: &RecordSeries, most: usize) -> Range<usize> {
    let length = record.t.len();
    let first = record.runs.iter().flatten().next();
    if length <= most {
        return 0..length;
    }
    let misses: Vec<f64> = first
        .map_or_else(|| vec![0.0; length], |run| record.y.iter().zip(&run.y).map(|(y, s)| y - s).collect());
    let start = worst_window(&misses, most);
    start..(start + most).min(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_band_holds_every_sample() {
        let t: Vec<f64> = (0..10_000).map(f64::from).collect();
        let y: Vec<f64> = t.iter().map(|t| (0.01 * t).sin()).collect();
        let half = vec![0.1; t.len()];
        let thin = band(&t, &y, &half);
        assert!(thin.len() <= COLUMNS + 1);
        for (k, y) in y.iter().enumerate() {
            let at = thin.iter().rev().find(|(t, ..)| *t <= k as f64).expect("it begins at the first sample");
            assert!(at.1 <= y - 0.1 && y + 0.1 <= at.2);
        }
    }
}
