//! The consistency study: Monte-Carlo replicates of every cell of a sweep, and what they amount to.
//!
//! One pass over the noise of a replicate serves every cell of the pulse methods (`noise_group`), another every cell of `free`, which needs no
//! designed experiment (`free`): the cells of a sweep share it by superposition. Replicates of the pulse methods go eight at once
//! (`family`, `lane_batch`); while all families take in the noise of some replicates, that of the next is drawn (`execute`; what runs, in which
//! pieces, is a `workload`). The oracle of
//! all this is an engine of its own, which simulates every cell (`direct`). What the sums say of a cell (`views`) is tabulated, judged over N
//! (`judge`) and compared between cells on the same noise (`paired`). Results depend on the scenario and its seed only.

mod bench;
mod cell;
mod cost;
mod direct;
mod execute;
mod expectations;
mod family;
mod family_plan;
mod free;
mod intervals;
mod judge;
mod lane_batch;
mod memory;
mod noise;
mod noise_group;
mod paired;
mod pulse_kind;
mod replay;
mod round;
mod sections;
mod setting;
mod tabulate;
mod views;
mod workload;

use crate::results::{BorderCurve, Results, SCHEMA};
use crate::scenario::{Coupling, Engine, Scenario};
use cell::CellSpec;
use direct::DirectGroup;
use execute::Outcome;
use std::ops::Range;
use thiserror::Error;
use workload::Workload;

pub use cost::least_seconds;
pub use execute::Progress;
pub use replay::{ReplayedCell, ReplayedExperiment, ReplayedRecords, records, replay};

/// Why a study cannot be run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A method has no limit on some cell: its information matrix is singular even with endless data.
    #[error(
        "{method} cannot be run on case `{case}`, border `{border}`, m = {points}: {source}; drop the method, or change the case"
    )]
    NoLimit {
        /// Name of the method.
        method: &'static str,
        /// Name of the case.
        case: String,
        /// Name of the border.
        border: String,
        /// Points `m`.
        points: usize,
        /// What the method says.
        source: switchback_estimator::estimators::pulse::PulseFitError,
    },
    /// The estimate from any record does not exist on some cell.
    #[error(
        "free cannot be run on case `{case}`, border `{border}`, m = {points}: {source}; lower sweep.points, raise sweep.samples, or drop the method"
    )]
    NotFromDrive {
        /// Name of the case.
        case: String,
        /// Name of the border.
        border: String,
        /// Knots `m` on each border.
        points: usize,
        /// What the method says.
        source: switchback_estimator::estimators::free::FreeError,
    },
    /// An experiment of the sweep cannot be built.
    #[error("case `{case}`, m = {points}: {reason}")]
    NoExperiment {
        /// Name of the case.
        case: String,
        /// Points `m`.
        points: usize,
        /// Why.
        reason: String,
    },
}

/// Runs a scenario to its result table. `command` is what the results name as the command that makes them again.
///
/// # Errors
/// [`StudyError`] if a method or an experiment does not exist for some cell.
pub fn run(scenario: &Scenario, command: String, progress: &dyn Progress) -> Result<Results, StudyError> {
    let pulses = noise_group::plan(scenario)?;
    let free = free::plan(scenario)?;
    let specs: Vec<CellSpec> =
        pulses.iter().flat_map(|w| w.specs(scenario)).chain(free.iter().flat_map(|w| w.specs())).collect();
    let direct: Vec<DirectGroup<'_>> = pulses.iter().map(|group| DirectGroup::new(group, scenario)).collect();
    let pulses: Vec<&dyn Workload> = match scenario.engine() {
        Engine::Superposed => pulses.iter().map(|w| w as &dyn Workload).collect(),
        Engine::Direct => direct.iter().map(|w| w as &dyn Workload).collect(),
    };
    let workloads: Vec<&dyn Workload> =
        pulses.into_iter().chain(free.iter().map(|w| w as &dyn Workload)).collect();
    let Outcome { sections, precise } = execute::run(scenario, &workloads, &specs, progress);
    let cells = tabulate::cells(&specs, &sections, precise.as_deref());
    let views = views::of_cells(&specs, &sections);
    let summaries = judge::summaries(&specs, &views, scenario.sweep().slope_from);
    let paired = (scenario.coupling() == Coupling::Shared)
        .then(|| paired::pairing(&specs, &views, &cells_of_worlds(&workloads)));
    let expectations = expectations::check(scenario, &summaries, &cells);
    Ok(Results {
        schema: SCHEMA,
        study: "consistency".to_owned(),
        name: scenario.name().to_owned(),
        question: scenario.question().to_owned(),
        seed: scenario.seed(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        command,
        engine: scenario.engine(),
        coupling: scenario.coupling(),
        slope_samples: scenario.sweep().slope_samples().to_vec(),
        labels: scenario.labels().clone(),
        scenario: scenario.source().clone(),
        curves: curves(scenario),
        expectations,
        summaries,
        paired,
        cells,
    })
}

/// Where the cells of each workload stand among all cells.
fn cells_of_worlds(workloads: &[&dyn Workload]) -> Vec<Range<usize>> {
    let mut first = 0;
    workloads
        .iter()
        .map(|workload| {
            let cells = first..first + workload.cells();
            first = cells.end;
            cells
        })
        .collect()
}

fn curves(scenario: &Scenario) -> Vec<BorderCurve> {
    scenario
        .cases()
        .iter()
        .flat_map(|case| case.borders.iter().map(|b| BorderCurve::sample(&case.name, &b.name, &b.hysteresis)))
        .collect()
}
