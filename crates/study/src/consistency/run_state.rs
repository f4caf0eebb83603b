//! How far a study has come, and when it has enough.

mod bytes;

pub(crate) use bytes::Origin;
pub use bytes::Unusable;

use super::batches::Batches;
use super::execute::{Overseer, Progress, Work};
use super::sections::{CellShape, CellSums};
use super::tally::Tally;
use crate::Shard;
use crate::scenario::{Replication, Scenario, Stopping};
use std::ops::{ControlFlow, Range};
use switchback_identify::statistics::{KnownControl, Performance};

/// What the replicates so far left behind, and the round running.
#[derive(Debug, Clone, PartialEq)]
pub struct RunState {
    pub(super) round: Round,
    pub(super) tally: Tally,
    /// Whether the scenario asks for a precision: rounds then end where their errors say.
    pub(super) in_rounds: bool,
    /// Versions of the methods of others; nothing before they were asked for them.
    pub(super) versions: Option<Vec<String>>,
}

/// The replicates between two looks at the stopping rule.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Round {
    pub(super) replicates: Range<usize>,
    /// Whether each cell takes part: those that are precise enough do not.
    pub(super) active: Vec<bool>,
}

/// Keeps how far a study has come, and may wish it to stop.
pub trait Keeper: Send + Sync {
    /// Another batch is done; a break stops the study.
    fn keep(&mut self, snapshot: &Snapshot<'_>) -> ControlFlow<()>;
    /// Whether the batch running is given up; asked often.
    fn is_stopped(&self) -> bool;
}

/// Nothing is kept, and nobody stops the study.
impl Keeper for () {
    fn keep(&mut self, _: &Snapshot<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn is_stopped(&self) -> bool {
        false
    }
}

/// A [`RunState`] while the study runs.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    pub(super) round: &'a Round,
    pub(super) tally: &'a Tally,
    pub(super) versions: Option<&'a [String]>,
}

/// The rule by which a study has enough replicates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule {
    replication: Replication,
    batches: Batches,
}

impl RunState {
    /// Before the first replicate.
    pub(super) fn new(rule: Rule, shape: Vec<CellShape>, versions: Option<Vec<String>>) -> Self {
        let round = Round { replicates: 0..rule.first(), active: vec![true; shape.len()] };
        let in_rounds = rule.replication.stopping.is_some();
        Self { round, tally: Tally::new(rule.batches, shape), in_rounds, versions }
    }

    /// Versions of the methods of others, in the order of the scenario, as far as they are known.
    pub(super) fn versions(&self) -> &[String] {
        self.versions.as_deref().unwrap_or_default()
    }

    /// Whether the methods of others had other versions in another part.
    pub fn differs_in_versions(&self, other: &Self) -> bool {
        self.versions.as_ref().zip(other.versions.as_ref()).is_some_and(|(own, other)| own != other)
    }

    /// How many replicates have been run of all cells that took part.
    pub fn replicates(&self) -> usize {
        self.tally.replicates()
    }

    /// Up to which replicate the round running goes.
    pub fn target(&self) -> usize {
        self.round.replicates.end
    }

    /// The first replicate that is missing, of those before the end of the round running.
    pub fn missing(&self) -> Option<Range<usize>> {
        self.tally.first_break(self.target()).map(|(end, start)| end..start)
    }

    /// The same round with none of its replicates run.
    #[must_use]
    pub fn emptied(&self) -> Self {
        let tally = Tally::new(self.tally.batches(), self.tally.shape().to_vec());
        Self { tally, ..self.clone() }
    }

    /// How many replicates of the round running are to be run, of a part or of all of it.
    pub fn left(&self, shard: Option<Shard>) -> usize {
        self.remaining(&self.share(shard)).len()
    }

    /// Adds the replicates of a part of the round running. Parts come in their order.
    pub fn add(&mut self, part: Self) {
        self.versions = self.versions.take().or(part.versions);
        part.tally.into_nodes().for_each(|node| self.tally.add(node));
    }

    /// The same as it is kept.
    pub fn snapshot(&self) -> Snapshot<'_> {
        Snapshot { round: &self.round, tally: &self.tally, versions: self.versions.as_deref() }
    }

    /// The replicates of the round running that a part runs.
    fn share(&self, shard: Option<Shard>) -> Range<usize> {
        let round = self.round.replicates.clone();
        shard.map_or(round.clone(), |shard| self.tally.batches().share(round, (shard.number, shard.of)))
    }

    /// Those of a share that have not been run.
    fn remaining(&self, share: &Range<usize>) -> Range<usize> {
        self.tally.end(share.start).clamp(share.start, share.end)..share.end
    }

    /// Runs what is left of the round running, or of a part of it.
    pub(super) fn finish_round(
        &mut self,
        work: Work<'_>,
        shard: Option<Shard>,
        watch: (&dyn Progress, &mut dyn Keeper),
    ) -> ControlFlow<()> {
        let left = self.remaining(&self.share(shard));
        let (progress, keeper) = watch;
        let versions = self.versions.as_deref();
        let mut reported = Reported { round: &self.round, versions, progress, keeper };
        let pieces = self.tally.batches().pieces(left);
        work.run(pieces, &self.round.active, &mut self.tally, &mut reported)
    }

    /// Looks at a round that is done: the next one, or `None` where there is enough.
    pub(super) fn look(&self, rule: Rule, progress: &dyn Progress) -> Option<Round> {
        let Some(stopping) = rule.replication.stopping else {
            let done = self.round.replicates.end;
            let more = done < rule.replication.replicates;
            return more
                .then(|| Round { replicates: done..rule.replication.replicates, ..self.round.clone() });
        };
        let (round, forecast) = rule.after(&stopping, &self.round, &self.tally.totals());
        progress.imprecise(round.active.iter().filter(|active| **active).count(), round.active.len());
        progress.planned(forecast as u64);
        (!round.replicates.is_empty()).then_some(round)
    }

    /// Whether each cell is as precise as the scenario asks; `None` where it does not ask.
    pub(super) fn precise(&self, rule: Rule) -> Option<Vec<bool>> {
        let stopping = rule.replication.stopping?;
        let (round, _) = rule.after(&stopping, &self.round, &self.tally.totals());
        Some(round.active.iter().map(|active| !active).collect())
    }
}

/// Passes on the news of the tally.
struct Reported<'a> {
    round: &'a Round,
    versions: Option<&'a [String]>,
    progress: &'a dyn Progress,
    keeper: &'a mut dyn Keeper,
}

impl Overseer for Reported<'_> {
    fn added(&mut self, replicates: usize, tally: &Tally) -> ControlFlow<()> {
        self.progress.advanced(replicates as u64);
        self.keeper.keep(&Snapshot { round: self.round, tally, versions: self.versions })
    }

    fn is_stopped(&self) -> bool {
        self.keeper.is_stopped()
    }
}

impl Rule {
    pub(super) fn of(scenario: &Scenario) -> Self {
        Self { replication: scenario.replication(), batches: Batches::of(scenario) }
    }

    pub(super) fn batches(self) -> Batches {
        self.batches
    }

    /// How many replicates the first round takes.
    fn first(self) -> usize {
        let Replication { replicates, stopping } = self.replication;
        stopping.map_or(replicates, |stopping| self.to_a_batch(replicates, &stopping))
    }

    /// Rounds end with a batch, so that no part of one is run by two.
    fn to_a_batch(self, replicates: usize, stopping: &Stopping) -> usize {
        replicates.next_multiple_of(self.batches.size()).min(stopping.max_replicates)
    }

    /// How many replicates a study takes in all, as far as that is known before the first: the error of a standard deviation depends on the
    /// number of replicates alone.
    pub(super) fn forecast(self) -> usize {
        let first = self.first();
        self.replication.stopping.map_or(first, |stopping| {
            let for_sd = stopping.sd_relative_mcse.map_or(0.0, |share| 1.0 + 0.5 / (share * share));
            first.max((for_sd.ceil() as usize).min(stopping.max_replicates))
        })
    }

    /// The round after one that is done, whose replicates are none where there is enough, and a forecast of all replicates.
    fn after(self, stopping: &Stopping, round: &Round, totals: &[CellSums]) -> (Round, usize) {
        let done = round.replicates.end;
        let mut active = round.active.clone();
        let mut factor: f64 = 0.0;
        for (active, total) in active.iter_mut().zip(totals).filter(|(active, _)| **active) {
            let excess = excess(stopping, total);
            *active = excess > 1.0;
            factor = factor.max(excess);
        }
        if factor <= 1.0 || done >= stopping.max_replicates {
            return (Round { replicates: done..done, active }, done);
        }
        // Errors fall as R^-1/2; at most four times as many at once, in case the estimate of the error is off.
        let wanted = |factor: f64| {
            let replicates = (done as f64 * factor).ceil() as usize;
            self.to_a_batch(replicates.max(done + MORE), stopping)
        };
        let forecast = wanted(factor * factor);
        (Round { replicates: done..wanted((factor * factor).min(4.0)), active }, forecast)
    }
}

/// Replicates that a further round takes at least.
const MORE: usize = 256;

/// The cell's largest Monte-Carlo error over the one allowed.
fn excess(stopping: &Stopping, total: &CellSums) -> f64 {
    let performances: Vec<Performance> =
        total.parameters(None).iter().filter_map(|sums| sums.performance(KnownControl::default())).collect();
    let worst = |ratio: &dyn Fn(&Performance) -> f64| {
        performances.iter().map(ratio).filter(|x| x.is_finite()).fold(0.0, f64::max)
    };
    let sd = stopping.sd_relative_mcse.map_or(0.0, |allowed| worst(&|p| p.sd.mcse / p.sd.value / allowed));
    let adjusted = total.foreign().and_then(|sums| sums.controls.adjusted(None, None));
    if let (Some(allowed), Some(adjusted)) = (stopping.bias_mcse, &adjusted) {
        let ratios = adjusted.iter().zip(&performances).map(|(a, p)| a.bias.mcse / p.sd.value / allowed);
        return sd.max(ratios.filter(|x| x.is_finite()).fold(0.0, f64::max));
    }
    let bias = stopping
        .bias_mcse
        .map_or(0.0, |allowed| worst(&|p| p.bias_controlled.unwrap_or(p.bias).mcse / p.sd.value / allowed));
    bias.max(sd)
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_identify::statistics::{ErrorSums, ReplicateError};

    fn rule(replicates: usize, stopping: Stopping) -> Rule {
        let replication = Replication { replicates, stopping: Some(stopping) };
        Rule { replication, batches: Batches::with_size(16) }
    }

    #[test]
    fn the_forecast_is_what_the_largest_error_calls_for() {
        let stopping = Stopping { bias_mcse: None, sd_relative_mcse: Some(0.01), max_replicates: 100_000 };
        let first = rule(40, stopping);
        assert_eq!((first.first(), first.forecast()), (48, 5001));
        let mut sums = CellSums::new(CellShape { parameters: 1, controls: None });
        let mut errors = ErrorSums::default();
        for error in (0..400).map(|r| f64::from(r % 2) - 0.5) {
            let (first_order, second_order, first_order_variance) = (None, 0.0, None);
            errors.push(ReplicateError { error, se: 0.5, first_order, second_order, first_order_variance });
        }
        let mut section = sums.section(0);
        section.parameters = vec![errors];
        sums.put_section(0, &section);
        let round = Round { replicates: 0..400, active: vec![true] };
        let next =
            |stopping: &Stopping| rule(40, *stopping).after(stopping, &round, std::slice::from_ref(&sums));
        // The relative error is (2·399)^-1/2, 3.54 times the one allowed.
        assert_eq!(next(&stopping), (Round { replicates: 400..1600, active: vec![true] }, 5024));
        let limited = Stopping { max_replicates: 1000, ..stopping };
        assert_eq!(next(&limited), (Round { replicates: 400..1000, active: vec![true] }, 1000));
        let modest = Stopping { sd_relative_mcse: Some(0.04), ..stopping };
        assert_eq!(next(&modest), (Round { replicates: 400..400, active: vec![false] }, 400));
    }
}
