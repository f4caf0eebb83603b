//! Unevenly sampled rows, brought to even ones.

use super::names::Between;
use super::taken::Series;
use std::ops::Range;

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resampled {
    /// The longest step that was bridged, seconds.
    pub longest: f64,
    /// How.
    pub between: Between,
}

/// Made-up samples in a row that are still called interpolation. More of them would be a record of straight lines that nobody measured; a
/// convention, not a measured border.
pub(super) const BRIDGED: f64 = 10.0;

/// Even samples every `step` seconds from the first row on; steps longer than `bridged` of them split the record.
///
/// Times increase. Rows of the result are those that the samples lie at or after.
pub(super) fn resample(
    series: &Series,
    t: &[f64],
    step: f64,
    (between, bridged): (Between, f64),
) -> (Series, Vec<Range<usize>>, Resampled) {
    let mut even = Series {
        v: Vec::new(),
        y: series.y.as_ref().map(|_| Vec::new()),
        predicted: series.predicted.as_ref().map(|_| Vec::new()),
        rows: Vec::new(),
    };
    let mut pieces = Vec::new();
    let mut longest: f64 = 0.0;
    let mut start = 0;
    while start < t.len() {
        let is_long = |k: &usize| t[*k] - t[*k - 1] > bridged * step;
        let end = (start + 1..t.len()).find(is_long).unwrap_or(t.len());
        let first = even.v.len();
        longest = (start + 1..end).map(|k| t[k] - t[k - 1]).fold(longest, f64::max);
        fill(&mut even, series, t, (start..end, step, between));
        pieces.push(first..even.v.len());
        start = end;
    }
    (even, pieces, Resampled { longest, between })
}

fn fill(even: &mut Series, series: &Series, t: &[f64], (rows, step, kind): (Range<usize>, f64, Between)) {
    let mut right = rows.start;
    // A last sample that rounding puts behind the last row by a trifle is still measured.
    let count = ((t[rows.end - 1] - t[rows.start]) / step + 1e-6).floor() as usize + 1;
    for k in 0..count {
        let now = (t[rows.start] + k as f64 * step).min(t[rows.end - 1]);
        while right + 1 < rows.end && t[right] < now {
            right += 1;
        }
        let left = if t[right] > now { right - 1 } else { right };
        let share =
            if left == right || kind == Between::Hold { 0.0 } else { (now - t[left]) / (t[right] - t[left]) };
        let between = |values: &[f64]| values[left] + share * (values[right] - values[left]);
        even.v.push(between(&series.v));
        if let (Some(even), Some(values)) = (&mut even.y, &series.y) {
            even.push(between(values));
        }
        if let (Some(even), Some(values)) = (&mut even.predicted, &series.predicted) {
            even.push(between(values));
        }
        even.rows.push(series.rows[left]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_are_met_and_long_steps_split() {
        let t = [0.0, 0.9, 2.2, 3.0, 20.0, 21.0, 21.5];
        let v: Vec<f64> = t.iter().map(|t| 2.0 * t + 1.0).collect();
        let series = Series { v, y: None, predicted: None, rows: (0..t.len()).collect() };
        let (even, pieces, reported) = resample(&series, &t, 1.0, (Between::Linear, BRIDGED));
        let expected = [1.0, 3.0, 5.0, 7.0, 41.0, 43.0];
        assert_eq!(pieces, [0..4, 4..6]);
        assert!(
            even.v.iter().zip(expected).all(|(found, wanted)| (found - wanted).abs() < 1e-12),
            "{:?}",
            even.v
        );
        assert!((reported.longest - 1.3).abs() < 1e-12);
    }
}
