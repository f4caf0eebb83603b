//! An identification and another one on the held-out records.

use super::baseline::Baseline;
use super::errors_of_run::RunErrors;
use super::result::Identification;
use switchback_identify::statistics::MeanInterval;
use switchback_model::rig::{Rig, Usage};

impl Baseline {
    /// Compares over the held-out records; `None` if nothing held out was simulated by both.
    pub(super) fn of(rig: &Rig, own: &Identification, other: &Identification) -> Option<Self> {
        let own_runs = RunErrors::of(rig, own, Usage::Holdout);
        let other_runs = RunErrors::of(rig, other, Usage::Holdout);
        let (mut differences, mut sums) = (Vec::new(), [0.0; 3]);
        for (own, other) in both(&own_runs, &other_runs) {
            let from = own.start.max(other.start);
            let y = &own.record.record.y()[from..];
            let mean = y.iter().sum::<f64>() / y.len().max(1) as f64;
            let squares: Vec<[f64; 2]> =
                own.squares_from(from).zip(other.squares_from(from)).map(Into::into).collect();
            for ([own, other], y) in squares.iter().zip(y) {
                sums = [sums[0] + own, sums[1] + other, sums[2] + (y - mean).powi(2)];
            }
            differences.push(squares.iter().map(|[own, other]| own - other).collect::<Vec<f64>>());
        }
        let [missed, missed_by_other, energy] = sums;
        if energy.is_nan() || energy <= 0.0 {
            return None;
        }
        let count: usize = differences.iter().map(Vec::len).sum();
        let variance = energy / count as f64;
        let shares: Vec<Vec<f64>> =
            differences.iter().map(|d| d.iter().map(|x| x / variance).collect()).collect();
        let fit = |missed: f64| 100.0 * (1.0 - (missed / energy).sqrt());
        Some(Self {
            method: other.method,
            fit_percent: fit(missed_by_other),
            own_fit_percent: fit(missed),
            excess: MeanInterval::of(&shares.iter().map(Vec::as_slice).collect::<Vec<_>>()),
        })
    }
}

/// The runs of the same records.
fn both<'r, 'a>(
    own: &'r [RunErrors<'a>],
    other: &'r [RunErrors<'a>],
) -> impl Iterator<Item = (&'r RunErrors<'a>, &'r RunErrors<'a>)> {
    own.iter().filter_map(|run| Some((run, other.iter().find(|o| std::ptr::eq(o.record, run.record))?)))
}
