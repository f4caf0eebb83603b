//! Where and by how much the free runs of an identification miss the records.

use super::Identification;
use switchback_model::rig::{Rig, RigRecord, Usage};

/// Free-run errors of one record from the first simulated sample on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RunErrors<'a> {
    pub(super) record: &'a RigRecord,
    /// First sample simulated.
    pub(super) start: usize,
    /// `y − ŷ`, output units.
    pub(super) errors: Vec<f64>,
}

impl<'a> RunErrors<'a> {
    /// Of every simulated record of one use.
    pub(super) fn of(rig: &'a Rig, identification: &Identification, usage: Usage) -> Vec<Self> {
        let simulated = rig.records.iter().zip(&identification.runs).filter(|(r, _)| r.usage == usage);
        simulated
            .filter_map(|(record, run)| {
                let run = run.as_ref()?;
                let pairs = record.record.y().iter().zip(&run.simulated).skip(run.start);
                Some(Self { record, start: run.start, errors: pairs.map(|(y, s)| y - s).collect() })
            })
            .collect()
    }

    /// Squares from a sample of the record on.
    pub(super) fn squares_from(&self, sample: usize) -> impl Iterator<Item = f64> {
        self.errors.iter().skip(sample.saturating_sub(self.start)).map(|e| e * e)
    }

    /// Squared distances of the measured output from its mean over the same samples.
    pub(super) fn squares_about_mean(&self) -> impl Iterator<Item = f64> {
        let y = &self.record.record.y()[self.start..];
        let mean = y.iter().sum::<f64>() / y.len().max(1) as f64;
        y.iter().map(move |y| (y - mean) * (y - mean))
    }
}
