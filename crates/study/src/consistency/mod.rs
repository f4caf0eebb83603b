//! The consistency study: Monte-Carlo replicates of every cell of a sweep, and what they amount to.
//!
//! One pass over the noise of a replicate serves every cell of the pulse methods (`noise_group`), another every cell of `free`, which needs no
//! designed experiment (`free`): the cells of a sweep share it by superposition. Replicates of the pulse methods go eight at once
//! (`cell_group`, `lane_batch`); while all families take in the noise of some replicates, that of the next is drawn (`execute`; what runs, in which
//! pieces, is a `workload`). The oracle of
//! all this is an engine of its own, which simulates every cell (`direct`). What the sums say of a cell (`views`) is tabulated, judged over N
//! (`judge`) and compared between cells on the same noise (`paired`). Results depend on the scenario and its seed only.

mod batches;
mod cell;
mod cell_design;
mod cell_group;
mod cell_group_plan;
mod control_sums;
mod controls;
mod cost;
mod direct;
mod error;
mod execute;
mod expectations;
mod foreign_noise_group;
mod free;
mod interval_ends;
mod intervals;
mod judge;
mod lane_batch;
mod least_seconds;
mod memory;
mod method_errors;
mod noise;
mod noise_group;
mod paired;
mod pulse_kind;
mod replay;
mod replicate_errors;
mod run_state;
mod sections;
mod setup;
mod single;
mod strong_id;
mod tabulate;
mod tally;
mod views;
mod workload;

use crate::Shard;
use crate::foreign::{ForeignEstimator, Processes};
use crate::results::{BorderCurve, Partial, Results, SCHEMA};
use crate::scenario::{Coupling, Engine, ForeignMethod, Scenario};
use cell::{CellSpec, CellTheory};
use direct::DirectGroup;
use execute::Work;
use foreign_noise_group::ForeignNoiseGroup;
use free::FreeNoiseGroup;
use noise_group::NoiseGroup;
use run_state::Rule;
use sections::CellShape;
use std::ops::{ControlFlow, Range};
use std::sync::{Arc, OnceLock};
use switchback_io::output::sha256;
use switchback_io::platform::platform;
use workload::Workload;

pub use error::StudyError;
pub use execute::Progress;
pub use least_seconds::least_seconds;
pub use method_errors::CellErrors;
pub use method_errors::method_errors;
pub use replay::ReplayedCell;
pub use replay::ReplayedExperiment;
pub use replay::records;
pub use replay::replay;
pub use replicate_errors::ReplicateErrors;
pub use run_state::Keeper;
pub(crate) use run_state::Origin;
pub use run_state::RunState;
pub use run_state::Snapshot;
pub use run_state::Unusable;
pub use single::Estimated;
pub use single::Single;
pub use single::SingleRecord;

/// A scenario with everything laid out that its replicates share.
#[derive(Debug)]
pub struct Study<'s> {
    scenario: &'s Scenario,
    pulses: Vec<NoiseGroup>,
    free: Vec<FreeNoiseGroup>,
    foreign: Vec<ForeignNoiseGroup>,
    estimators: Vec<Arc<dyn ForeignEstimator>>,
    /// Versions of the methods of others, once they have been asked.
    versions: OnceLock<Vec<String>>,
    specs: Vec<CellSpec>,
    rule: Rule,
}

/// Whether all replicates that were asked for have been run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub enum Ended {
    /// They have.
    Finished,
    /// The [`Keeper`] wished the study to stop: what was run of the batch running is lost.
    Stopped,
}

impl<'s> Study<'s> {
    /// Lays a scenario out.
    ///
    /// # Errors
    /// [`StudyError`] if a method or an experiment does not exist for some cell.
    pub fn plan(scenario: &'s Scenario) -> Result<Self, StudyError> {
        Self::plan_with(scenario, Vec::new())
    }

    /// The same, where some of the methods of others are functions: in the order of the scenario, whoever estimates for each.
    ///
    /// # Errors
    /// [`StudyError`] if a method or an experiment does not exist for some cell, or nobody estimates for a method.
    pub fn plan_with(
        scenario: &'s Scenario,
        functions: Vec<Arc<dyn ForeignEstimator>>,
    ) -> Result<Self, StudyError> {
        let estimators = estimators(scenario, functions)?;
        let (pulses, free) = (noise_group::plan(scenario)?, free::plan(scenario)?);
        let of_pulses = pulses.iter().flat_map(|w| w.specs(scenario));
        let mut specs: Vec<CellSpec> = of_pulses.chain(free.iter().flat_map(|w| w.specs())).collect();
        let foreign = foreign_noise_group::plan(scenario, &estimators, (pulses.len(), specs.len()))?;
        specs.extend(foreign.iter().flat_map(ForeignNoiseGroup::specs));
        let (rule, versions) = (Rule::of(scenario), OnceLock::new());
        Ok(Self { scenario, pulses, free, foreign, estimators, versions, specs, rule })
    }

    /// Makes sure that the methods of others can be asked. To be called before replicates are run.
    ///
    /// # Errors
    /// [`StudyError`] where one cannot.
    pub fn begin_methods(&self) -> Result<(), StudyError> {
        let versions = self.estimators.iter().map(|estimator| estimator.begin());
        let versions = versions.collect::<Result<_, _>>().map_err(StudyError::NoMethod)?;
        let _first = self.versions.set(versions);
        Ok(())
    }

    /// Before the first replicate.
    pub fn begin(&self) -> RunState {
        RunState::new(self.rule, self.shape(), self.versions.get().cloned())
    }

    /// What the sums of each cell hold.
    fn shape(&self) -> Vec<CellShape> {
        let ours = self.specs.len() - self.foreign.iter().map(Workload::cells).sum::<usize>();
        let controls = std::iter::repeat_n(None, ours);
        let controls = controls.chain(self.foreign.iter().flat_map(|w| w.shapes()).map(Some));
        let shape =
            |(spec, controls): (&CellSpec, _)| CellShape { parameters: spec.parameters.len(), controls };
        self.specs.iter().zip(controls).map(shape).collect()
    }

    /// What the replicates are of: the scenario, but for their number where no precision is asked for; sources by their hash, on this platform.
    pub fn origin(&self, sources: &str) -> Origin {
        let Self { scenario, .. } = self;
        let replication = scenario.replication();
        let rule = replication.stopping.map(|stopping| (replication.replicates, stopping));
        let what = (scenario.cases(), scenario.sweep(), scenario.coupling(), scenario.engine(), rule);
        let foreign = match scenario.foreign() {
            [] => String::new(),
            methods => format!(" {methods:?}"),
        };
        Origin {
            scenario: sha256(format!("{} {what:?}{foreign}", scenario.seed())),
            part: String::new(),
            program: sources.to_owned(),
            platform: platform(),
        }
    }

    /// How many replicates are run in all, as far as is known when the first round is running.
    pub fn forecast(&self) -> usize {
        self.rule.forecast()
    }

    /// Goes on to the next round; false where there is enough. All replicates of the round running have been run.
    pub fn next_round(&self, run_state: &mut RunState, progress: &dyn Progress) -> bool {
        match run_state.look(self.rule, progress) {
            Some(next) => run_state.round = next,
            None => return false,
        }
        true
    }

    /// Runs replicates until the scenario has enough of them.
    pub fn run(&self, run_state: &mut RunState, progress: &dyn Progress, keeper: &mut dyn Keeper) -> Ended {
        loop {
            if self.run_part(run_state, None, (progress, &mut *keeper)) == Ended::Stopped {
                return Ended::Stopped;
            }
            if !self.next_round(run_state, progress) {
                return Ended::Finished;
            }
        }
    }

    /// Runs what is left of the round running, or of one of equal parts of it.
    pub fn run_part(
        &self,
        run_state: &mut RunState,
        shard: Option<Shard>,
        watch: (&dyn Progress, &mut dyn Keeper),
    ) -> Ended {
        match self.with_work(|work| run_state.finish_round(work, shard, watch)) {
            ControlFlow::Continue(()) => Ended::Finished,
            ControlFlow::Break(()) => Ended::Stopped,
        }
    }

    /// Lends what runs replicates.
    fn with_work<T>(&self, run: impl FnOnce(Work<'_>) -> T) -> T {
        let scenario = self.scenario;
        let direct: Vec<DirectGroup<'_>> =
            self.pulses.iter().map(|group| DirectGroup::new(group, scenario)).collect();
        let pulses: Vec<&dyn Workload> = match scenario.engine() {
            Engine::Superposed => self.pulses.iter().map(|w| w as &dyn Workload).collect(),
            Engine::Direct => direct.iter().map(|w| w as &dyn Workload).collect(),
        };
        let foreign = self.foreign.iter().map(|w| w as &dyn Workload);
        let workloads: Vec<&dyn Workload> =
            pulses.into_iter().chain(self.free.iter().map(|w| w as &dyn Workload)).chain(foreign).collect();
        run(Work { seed: scenario.seed(), workloads: &workloads })
    }

    /// What the replicates so far amount to. `command` is what the results name as the command that makes them again.
    pub fn results(&self, run_state: &RunState, command: String) -> Results {
        let Self { scenario, specs, .. } = self;
        let totals = run_state.tally.totals();
        let precise = run_state.precise(self.rule);
        let theories = self.theories();
        let mut cells = tabulate::cells(specs, &theories, &totals, precise.as_deref());
        if !self.foreign.is_empty() {
            let ids = strong_id::strong_ids(scenario, specs, run_state.versions());
            cells.iter_mut().zip(ids).for_each(|(cell, id)| cell.strong_id = Some(id));
        }
        let views = views::of_cells(&theories, &totals);
        let summaries = judge::summaries(specs, &theories, &views, scenario.sweep().slope_from);
        let paired = (scenario.coupling() == Coupling::Shared)
            .then(|| paired::pairing(specs, &views, &self.cells_of_noise_groups()));
        let expectations = expectations::check(scenario, &summaries, &cells);
        let of = run_state.target();
        let partial = run_state.missing().map(|_| Partial { replicates: run_state.replicates(), of });
        Results {
            schema: SCHEMA,
            study: "consistency".to_owned(),
            name: scenario.name().to_owned(),
            question: scenario.question().to_owned(),
            seed: scenario.seed(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            command,
            partial,
            digits: None,
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
        }
    }

    /// What theory says of each cell. Only results need it: a part of a study does without.
    fn theories(&self) -> Vec<CellTheory> {
        let of_pulses = self.pulses.iter().flat_map(NoiseGroup::theories);
        let of_free = self.free.iter().flat_map(FreeNoiseGroup::theories);
        of_pulses.chain(of_free).chain(self.foreign.iter().flat_map(ForeignNoiseGroup::theories)).collect()
    }

    /// The cells that share their noise, by their places among all: methods of others share that of the pulse methods.
    fn cells_of_noise_groups(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> =
            self.cells_of_workloads().into_iter().map(Iterator::collect).collect();
        let foreign = groups.split_off(self.pulses.len() + self.free.len());
        groups.iter_mut().zip(foreign).for_each(|(group, more)| group.extend(more));
        groups
    }

    /// Where the cells of each workload stand among all cells.
    fn cells_of_workloads(&self) -> Vec<Range<usize>> {
        let counts = self.pulses.iter().map(|group| group.cells().count());
        let counts = counts.chain(self.free.iter().map(Workload::cells));
        let counts = counts.chain(self.foreign.iter().map(Workload::cells));
        let mut first = 0;
        counts
            .map(|count| {
                let cells = first..first + count;
                first = cells.end;
                cells
            })
            .collect()
    }
}

/// Runs a scenario to its result table, keeping nothing meanwhile. `command` is what the results name as the command that makes them again.
///
/// # Errors
/// [`StudyError`] if a method or an experiment does not exist for some cell.
pub fn run(scenario: &Scenario, command: String, progress: &dyn Progress) -> Result<Results, StudyError> {
    let study = Study::plan(scenario)?;
    study.begin_methods()?;
    let mut run_state = study.begin();
    progress.planned(study.rule.forecast() as u64);
    match study.run(&mut run_state, progress, &mut ()) {
        Ended::Finished => Ok(study.results(&run_state, command)),
        Ended::Stopped => unreachable!("nobody stops it"),
    }
}

/// Who estimates for each method of others: processes, or the functions in their order.
fn estimators(
    scenario: &Scenario,
    functions: Vec<Arc<dyn ForeignEstimator>>,
) -> Result<Vec<Arc<dyn ForeignEstimator>>, StudyError> {
    let mut functions = functions.into_iter();
    let of = |method: &ForeignMethod| match Processes::of(method) {
        Some(processes) => Ok(Arc::new(processes) as Arc<dyn ForeignEstimator>),
        None => functions.next().ok_or_else(|| StudyError::NobodyEstimates(method.name.as_str().to_owned())),
    };
    scenario.foreign().iter().map(of).collect()
}

fn curves(scenario: &Scenario) -> Vec<BorderCurve> {
    scenario
        .cases()
        .iter()
        .flat_map(|case| case.borders.iter().map(|b| BorderCurve::sample(&case.name, &b.name, &b.hysteresis)))
        .collect()
}
