//! One replicate alone, run as it was in the study: to look into a failure, or an estimate that is far off.

use super::execute::{Overseer, Work};
use super::foreign_noise_group::ForeignNoiseGroup;
use super::replay::{ReplayedExperiment, ReplayedRecords, records};
use super::sections::CellSums;
use super::tally::Tally;
use super::workload::Workload;
use super::{CellSpec, Study, StudyError};
use crate::results::Series;
use schemars::JsonSchema;
use serde::Serialize;
use std::iter;
use std::ops::ControlFlow;
use switchback_identify::excitation::Direction;
use switchback_identify::statistics::ErrorSums;

/// What one replicate gave in one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Single {
    /// In the order of the results, or why there are none.
    pub estimates: Result<Vec<Estimated>, String>,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Estimated {
    /// Its name in the results.
    pub name: String,
    /// The true value.
    pub truth: f64,
    /// The estimate less the truth.
    #[schemars(with = "Option<f64>")]
    pub error: f64,
    /// The standard error that the method reports.
    #[schemars(with = "Option<f64>")]
    pub se: f64,
}

impl Study<'_> {
    /// Runs one replicate, by number, in every cell: the same noise and the same arithmetic as in the study. In the order of the cells.
    pub fn replicate(&self, replicate: usize) -> Vec<Single> {
        let mut tally = Tally::new(self.rule.batches(), self.shape());
        let all = vec![true; self.specs.len()];
        let run = |work: Work<'_>| {
            let pieces = iter::once(replicate..replicate + 1);
            work.run(pieces, &all, &mut tally, &mut Nobody)
        };
        let _never_stopped = self.with_work(run);
        let totals = tally.totals();
        self.specs.iter().zip(&totals).map(|(spec, sums)| Single::of(spec, sums)).collect()
    }
}

/// A record that a cell's estimate is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct SingleRecord {
    /// Which experiment: `descendant` and `ascendant` of the pulse methods, `record` of the method `free`.
    pub name: &'static str,
    /// `v(t)`, input units.
    pub v: Vec<f64>,
    /// `y(t)`, output units.
    pub y: Vec<f64>,
}

impl Study<'_> {
    /// The records of one replicate in a cell, by their place in the results, up to its number of samples.
    ///
    /// # Errors
    /// [`StudyError`] never in practice: the study was planned.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn records(&self, cell: usize, replicate: u32) -> Result<Vec<SingleRecord>, StudyError> {
        let spec = &self.specs[cell];
        let mut before: usize = self.pulses.iter().map(|group| group.cells().count()).sum();
        for group in &self.free {
            if (before..before + group.cells()).contains(&cell) {
                let (v, y) = group.record(cell - before, self.scenario.seed(), replicate);
                return Ok(vec![SingleRecord { name: "record", v, y }]);
            }
            before += group.cells();
        }
        let of_foreign = |group: &ForeignNoiseGroup| group.records(cell, self.scenario.seed(), replicate);
        if let Some(found) = self.foreign.iter().find_map(of_foreign) {
            let names = ["descendant", "ascendant"].into_iter();
            return Ok(names.zip(found).map(|(name, (v, y))| SingleRecord { name, v, y }).collect());
        }
        let is_wanted = |records: &ReplayedRecords| {
            let Series { case, border, points, noise, .. } = &spec.series;
            (&records.case, &records.border, records.points, records.noise) == (case, border, *points, *noise)
        };
        let record = |experiment: ReplayedExperiment| {
            let ReplayedExperiment { direction, lead, mut v, mut y, .. } = experiment;
            v.truncate(lead + spec.samples);
            y.truncate(lead + spec.samples);
            let name = if direction == Direction::Descendant { "descendant" } else { "ascendant" };
            SingleRecord { name, v, y }
        };
        let found = records(self.scenario, replicate)?.into_iter().find(is_wanted);
        Ok(found.into_iter().flat_map(|records| records.experiments).map(record).collect())
    }
}

impl Single {
    fn of(spec: &CellSpec, sums: &CellSums) -> Self {
        if let Some(failure) = sums.runs.failures.first() {
            return Self { estimates: Err(failure.reason.clone()) };
        }
        let sums = sums.parameters(None);
        let names = spec.parameters.iter().map(|parameter| parameter.name.clone());
        let errors = sums.iter().filter_map(ErrorSums::single);
        let estimated = |((name, &truth), (error, se))| Estimated { name, truth, error, se };
        Self { estimates: Ok(names.zip(&spec.truth).zip(errors).map(estimated).collect()) }
    }
}

/// No listener.
struct Nobody;

impl Overseer for Nobody {
    fn added(&mut self, _: usize, _: &Tally) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn is_stopped(&self) -> bool {
        false
    }
}
