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
mod cost;
mod direct;
mod error;
mod execute;
mod expectations;
mod free;
mod intervals;
mod judge;
mod lane_batch;
mod least_seconds;
mod memory;
mod noise;
mod noise_group;
mod paired;
mod pulse_kind;
mod replay;
mod run_state;
mod sections;
mod setup;
mod single;
mod tabulate;
mod tally;
mod views;
mod workload;

use crate::Shard;
use crate::results::{BorderCurve, Partial, Results, SCHEMA};
use crate::scenario::{Coupling, Engine, Scenario};
use cell::{CellSpec, CellTheory};
use direct::DirectGroup;
use execute::Work;
use free::FreeNoiseGroup;
use noise_group::NoiseGroup;
use run_state::Rule;
use std::ops::{ControlFlow, Range};
use switchback_io::output::sha256;
use switchback_io::platform::platform;
use workload::Workload;

pub use error::StudyError;
pub use execute::Progress;
pub use least_seconds::least_seconds;
pub use replay::ReplayedCell;
pub use replay::ReplayedExperiment;
pub use replay::records;
pub use replay::replay;
pub use run_state::Keeper;
pub(crate) use run_state::Origin;
pub use run_state::RunState;
pub use run_state::Snapshot;
pub(crate) use run_state::Unusable;
pub use single::Estimated;
pub use single::Single;
pub use single::SingleRecord;

/// A scenario with everything laid out that its replicates share.
#[derive(Debug)]
pub struct Study<'s> {
    scenario: &'s Scenario,
    pulses: Vec<NoiseGroup>,
    free: Vec<FreeNoiseGroup>,
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
        let (pulses, free) = (noise_group::plan(scenario)?, free::plan(scenario)?);
        let of_pulses = pulses.iter().flat_map(|w| w.specs(scenario));
        let specs = of_pulses.chain(free.iter().flat_map(|w| w.specs())).collect();
        Ok(Self { scenario, pulses, free, specs, rule: Rule::of(scenario) })
    }

    /// Before the first replicate.
    pub fn begin(&self) -> RunState {
        RunState::new(self.rule, &self.specs)
    }

    /// What the replicates are of: the scenario, but for their number where no precision is asked for; sources by their hash, on this platform.
    pub fn origin(&self, sources: &str) -> Origin {
        let Self { scenario, .. } = self;
        let replication = scenario.replication();
        let rule = replication.stopping.map(|stopping| (replication.replicates, stopping));
        let what = (scenario.cases(), scenario.sweep(), scenario.coupling(), scenario.engine(), rule);
        Origin {
            scenario: sha256(format!("{} {what:?}", scenario.seed())),
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
        let workloads: Vec<&dyn Workload> =
            pulses.into_iter().chain(self.free.iter().map(|w| w as &dyn Workload)).collect();
        run(Work { seed: scenario.seed(), workloads: &workloads })
    }

    /// What the replicates so far amount to. `command` is what the results name as the command that makes them again.
    pub fn results(&self, run_state: &RunState, command: String) -> Results {
        let Self { scenario, specs, .. } = self;
        let totals = run_state.tally.totals();
        let precise = run_state.precise(self.rule);
        let theories = self.theories();
        let cells = tabulate::cells(specs, &theories, &totals, precise.as_deref());
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
        of_pulses.chain(self.free.iter().flat_map(FreeNoiseGroup::theories)).collect()
    }

    /// Where the cells of each workload stand among all cells.
    fn cells_of_noise_groups(&self) -> Vec<Range<usize>> {
        let counts = self.pulses.iter().map(|group| group.cells().count());
        let counts = counts.chain(self.free.iter().map(Workload::cells));
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
    let mut run_state = study.begin();
    progress.planned(study.rule.forecast() as u64);
    match study.run(&mut run_state, progress, &mut ()) {
        Ended::Finished => Ok(study.results(&run_state, command)),
        Ended::Stopped => unreachable!("nobody stops it"),
    }
}

fn curves(scenario: &Scenario) -> Vec<BorderCurve> {
    scenario
        .cases()
        .iter()
        .flat_map(|case| case.borders.iter().map(|b| BorderCurve::sample(&case.name, &b.name, &b.hysteresis)))
        .collect()
}
