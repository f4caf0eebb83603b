//! `switchback SCENARIO.toml` where it describes a consistency study: all of it, or one of equal parts.

mod merge;
mod order;
mod part;

pub(crate) use crate::build::BUILD;
use crate::interrupt;
pub(crate) use merge::merge;
pub(crate) use order::Order;

use super::partial;
use crate::failure::{CommandResult, Outcome};
use crate::interrupt::SignalGuard;
use crate::options::{Quiet, Threads};
use crate::progress::Meter;
use miette::IntoDiagnostic;
use part::Part;
use schemars::Schema;
use std::path::Path;
use switchback_io::output::{Artefacts, OutputFolder, note};
use switchback_io::provenance::{PROVENANCE_FILE, Provenance};
use switchback_report::study as report;
use switchback_study::Shard;
use switchback_study::checkpoint::{CHECKPOINT_FILE, Checkpoint, Found};
use switchback_study::consistency::{self, Ended, Progress, RunState, Study};
use switchback_study::results::{Results, to_json};
use switchback_study::scenario::Scenario;

/// The JSON Schema of the label of a part.
pub(crate) fn part_schema() -> Schema {
    part::schema()
}

/// What the folder of a report gets.
const FILES: [&str; report::FILES.len() + 2] = {
    let mut files = [CHECKPOINT_FILE; report::FILES.len() + 2];
    let (written, _) = files.split_at_mut(report::FILES.len());
    written.copy_from_slice(&report::FILES);
    files[report::FILES.len() + 1] = PROVENANCE_FILE;
    files
};

/// Claims the folder, takes up what a former run left, runs, writes, prints.
///
/// # Errors
/// A study that cannot be run, or a folder that cannot be written.
pub(crate) fn run(scenario: &Scenario, order: Order<'_>) -> CommandResult {
    match order.shard {
        Some(shard) => run_part(scenario, shard, order),
        None => run_whole(scenario, order),
    }
}

fn run_whole(scenario: &Scenario, order: Order<'_>) -> CommandResult {
    let provenance = Provenance::begin(BUILD, order.threads.at_once());
    let study = order.threads.install(|| Study::plan(scenario))?.into_diagnostic()?;
    study.begin_methods().into_diagnostic()?;
    let default = || Path::new("reports").join(scenario.name());
    let folder = order.force.claim(&order.out.map_or_else(default, Path::to_owned), &FILES)?;
    let mut kept = Checkpoint::new(folder.path(), study.origin(BUILD.study_sources), interrupt::is_wished);
    let mut run_state = taken_up(&kept, &study.begin(), order.quiet)?;
    let meter = Meter::new(order.quiet);
    meter.begin(study.forecast().max(run_state.target()), run_state.replicates());
    let ended = {
        let _signal_guard = SignalGuard::new();
        order.threads.install(|| study.run(&mut run_state, &meter, &mut kept))?
    };
    meter.finish();
    kept.conclude(&run_state, ended)?;
    let results = order.threads.install(|| study.results(&run_state, order.command.to_owned()))?;
    if ended == Ended::Stopped {
        return describe_partial(&results, folder, order);
    }
    let provenance = provenance.end(Vec::new());
    let outcome = write(&results, (scenario, &run_state, &kept, &provenance), folder, order)?;
    kept.close()?;
    Ok(outcome)
}

/// Runs one of equal parts of the round running, which `merge` puts together.
fn run_part(scenario: &Scenario, shard: Shard, order: Order<'_>) -> CommandResult {
    let provenance = Provenance::begin(BUILD, order.threads.at_once());
    let Shard { number, of } = shard;
    let default = || Path::new("reports").join(format!("{}-part-{number}-of-{of}", scenario.name()));
    let out = order.out.map_or_else(default, Path::to_owned);
    let study = order.threads.install(|| Study::plan(scenario))?.into_diagnostic()?;
    study.begin_methods().into_diagnostic()?;
    let begin = match order.from {
        Some(folder) => Part::read(folder)?.run_state(&study)?.emptied(),
        None => study.begin(),
    };
    let part = Part::new(order, scenario.engine(), Some(shard))?;
    let folder = order.force.claim(&out, &part.files())?;
    folder.refuse_part(Some(part.label().as_bytes()))?;
    let mut kept = Checkpoint::new(
        folder.path(),
        study.origin(BUILD.study_sources).of_part(Some(shard), &begin),
        interrupt::is_wished,
    );
    let mut run_state = taken_up(&kept, &begin, order.quiet)?;
    let meter = Meter::new(order.quiet);
    meter.begin(run_state.replicates() + run_state.left(Some(shard)), run_state.replicates());
    let ended = {
        let _signal_guard = SignalGuard::new();
        let watch = (&meter as &dyn Progress, &mut kept as &mut dyn consistency::Keeper);
        order.threads.install(|| study.run_part(&mut run_state, Some(shard), watch))?
    };
    meter.finish();
    kept.conclude(&run_state, ended)?;
    if ended == Ended::Stopped {
        let left = run_state.left(Some(shard));
        note(&format!(
            "stopped; {left} replicates of part {shard} are left, run the same command again to go on\n"
        ));
        return Ok(Outcome::Stopped);
    }
    let mut artefacts = part.artefacts(kept.bytes(&run_state));
    artefacts.add_beside(PROVENANCE_FILE, provenance.end(Vec::new()).text());
    folder.commit(&artefacts)?;
    kept.close()?;
    order.quiet.describe(&format!("part {shard} written to {}\n", out.display()))?;
    Ok(Outcome::Done)
}

/// Where a study goes on, once that is reported.
fn taken_up(kept: &Checkpoint, begin: &RunState, quiet: Quiet) -> miette::Result<RunState> {
    let Found { run_state, reported } = kept.take_up(begin)?;
    if let Some(reported) = reported {
        quiet.note(&format!("{reported}\n"));
    }
    Ok(run_state)
}

/// Writes the report and prints what came out.
fn write(
    results: &Results,
    (scenario, run_state, kept, provenance): (&Scenario, &RunState, &Checkpoint, &Provenance),
    folder: OutputFolder,
    order: Order<'_>,
) -> CommandResult {
    let mut artefacts = artefacts(results, order.threads)?;
    if kept.is_worth_it(consistency::least_seconds(scenario)) {
        artefacts.add_beside(CHECKPOINT_FILE, kept.bytes(run_state));
    }
    artefacts.add_beside(PROVENANCE_FILE, provenance.text());
    let place = folder.path().to_owned();
    folder.commit(&artefacts)?;
    partial::forget(&place, &FILES, order.force);
    describe(results, &place, order)?;
    Ok(if results.as_expected() { Outcome::Done } else { Outcome::Unmet })
}

/// Writes what a study that was stopped amounts to beside the report that will be.
fn describe_partial(results: &Results, folder: OutputFolder, order: Order<'_>) -> CommandResult {
    let place = partial::place(folder.path());
    drop(folder);
    order.force.claim(&place, &FILES)?.commit(&artefacts(results, order.threads)?)?;
    describe(results, &place, order)?;
    note("stopped; what was finished is kept, run the same command again to go on\n");
    Ok(Outcome::Stopped)
}

fn artefacts(results: &Results, threads: Threads) -> miette::Result<Artefacts> {
    Ok(threads.install(|| report::artefacts(results))??)
}

fn describe(results: &Results, place: &Path, order: Order<'_>) -> miette::Result<()> {
    let words = || format!("{}\nwritten to {}\n", report::table(results).trim_end(), place.display());
    order.quiet.describe_or(order.json, || to_json(results), words)
}
