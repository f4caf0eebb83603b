//! `switchback SCENARIO.toml` where it describes a consistency study: all of it, or one of equal parts.

mod merge;
mod order;
mod part;

pub use crate::build::BUILD;
use crate::interrupt;
pub use merge::merge;
pub use order::Order;

use super::partial;
use crate::failure::{CommandResult, Outcome};
use crate::interrupt::Heeding;
use crate::options::{Quiet, Threads};
use crate::progress::Meter;
use miette::IntoDiagnostic;
use part::Part;
use std::path::Path;
use switchback_io::output::{Artefacts, OutputFolder, note};
use switchback_io::provenance::{PROVENANCE_FILE, Provenance};
use switchback_report::study as report;
use switchback_study::Shard;
use switchback_study::checkpoint::{Found, KEPT_FILE, Kept};
use switchback_study::consistency::{self, Ended, Progress, Standing, Study};
use switchback_study::results::{Results, to_json};
use switchback_study::scenario::Scenario;

/// What the folder of a report gets.
const FILES: [&str; report::FILES.len() + 2] = {
    let mut files = [KEPT_FILE; report::FILES.len() + 2];
    let (written, _) = files.split_at_mut(report::FILES.len());
    written.copy_from_slice(&report::FILES);
    files[report::FILES.len() + 1] = PROVENANCE_FILE;
    files
};

/// Claims the folder, takes up what a former run left, runs, writes, prints.
///
/// # Errors
/// A study that cannot be run, or a folder that cannot be written.
pub fn run(scenario: &Scenario, order: Order<'_>) -> CommandResult {
    match order.shard {
        Some(shard) => run_part(scenario, shard, order),
        None => run_whole(scenario, order),
    }
}

fn run_whole(scenario: &Scenario, order: Order<'_>) -> CommandResult {
    let provenance = Provenance::begin(BUILD, order.threads.at_once());
    let default = || Path::new("reports").join(scenario.name());
    let folder = order.force.claim(&order.out.map_or_else(default, Path::to_owned), &FILES)?;
    let study = order.threads.install(|| Study::plan(scenario))?.into_diagnostic()?;
    let mut kept = Kept::new(folder.path(), study.origin(BUILD.study_sources), interrupt::is_wished);
    let mut standing = taken_up(&kept, &study.begin(), order.quiet)?;
    let meter = Meter::new(order.quiet);
    meter.begin(study.forecast().max(standing.target()), standing.replicates());
    let ended = {
        let _heeding = Heeding::new();
        order.threads.install(|| study.run(&mut standing, &meter, &mut kept))?
    };
    meter.finish();
    kept.conclude(&standing, ended)?;
    let results = order.threads.install(|| study.results(&standing, order.command.to_owned()))?;
    if ended == Ended::Stopped {
        return tell_partial(&results, folder, order);
    }
    let provenance = provenance.end(Vec::new());
    let outcome = write(&results, (scenario, &standing, &kept, &provenance), folder, order)?;
    kept.close()?;
    Ok(outcome)
}

/// Runs one of equal parts of the round under way, which `merge` puts together.
fn run_part(scenario: &Scenario, shard: Shard, order: Order<'_>) -> CommandResult {
    let provenance = Provenance::begin(BUILD, order.threads.at_once());
    let Shard { number, of } = shard;
    let default = || Path::new("reports").join(format!("{}-part-{number}-of-{of}", scenario.name()));
    let out = order.out.map_or_else(default, Path::to_owned);
    let study = order.threads.install(|| Study::plan(scenario))?.into_diagnostic()?;
    let begin = match order.from {
        Some(folder) => Part::read(folder)?.standing(&study)?.emptied(),
        None => study.begin(),
    };
    let part = Part::new(order, scenario.engine(), Some(shard))?;
    let folder = order.force.claim(&out, &part.files())?;
    let mut kept = Kept::new(
        folder.path(),
        study.origin(BUILD.study_sources).of_part(Some(shard), &begin),
        interrupt::is_wished,
    );
    let mut standing = taken_up(&kept, &begin, order.quiet)?;
    let meter = Meter::new(order.quiet);
    meter.begin(standing.replicates() + standing.left(Some(shard)), standing.replicates());
    let ended = {
        let _heeding = Heeding::new();
        let watch = (&meter as &dyn Progress, &mut kept as &mut dyn consistency::Keeper);
        order.threads.install(|| study.run_part(&mut standing, Some(shard), watch))?
    };
    meter.finish();
    kept.conclude(&standing, ended)?;
    if ended == Ended::Stopped {
        let left = standing.left(Some(shard));
        note(&format!(
            "stopped; {left} replicates of part {shard} are left, run the same command again to go on\n"
        ));
        return Ok(Outcome::Stopped);
    }
    let mut artefacts = part.artefacts(kept.bytes(&standing));
    artefacts.add_beside(PROVENANCE_FILE, provenance.end(Vec::new()).text());
    folder.commit(&artefacts)?;
    kept.close()?;
    order.quiet.tell(&format!("part {shard} written to {}\n", out.display()))?;
    Ok(Outcome::Done)
}

/// Where a study goes on, once that is told.
fn taken_up(kept: &Kept, begin: &Standing, quiet: Quiet) -> miette::Result<Standing> {
    let Found { standing, told } = kept.take_up(begin)?;
    if let Some(told) = told {
        quiet.note(&format!("{told}\n"));
    }
    Ok(standing)
}

/// Writes the report and prints what came out.
fn write(
    results: &Results,
    (scenario, standing, kept, provenance): (&Scenario, &Standing, &Kept, &Provenance),
    folder: OutputFolder,
    order: Order<'_>,
) -> CommandResult {
    let mut artefacts = artefacts(results, order.threads)?;
    if kept.is_worth_it(consistency::least_seconds(scenario)) {
        artefacts.add_beside(KEPT_FILE, kept.bytes(standing));
    }
    artefacts.add_beside(PROVENANCE_FILE, provenance.text());
    let place = folder.path().to_owned();
    folder.commit(&artefacts)?;
    partial::forget(&place, &FILES, order.force);
    tell(results, &place, order)?;
    Ok(if results.as_expected() { Outcome::Done } else { Outcome::Unmet })
}

/// Writes what a study that was stopped amounts to beside the report that will be.
fn tell_partial(results: &Results, folder: OutputFolder, order: Order<'_>) -> CommandResult {
    let place = partial::place(folder.path());
    drop(folder);
    order.force.claim(&place, &FILES)?.commit(&artefacts(results, order.threads)?)?;
    tell(results, &place, order)?;
    note("stopped; what was finished is kept, run the same command again to go on\n");
    Ok(Outcome::Stopped)
}

fn artefacts(results: &Results, threads: Threads) -> miette::Result<Artefacts> {
    Ok(threads.install(|| report::artefacts(results))??)
}

fn tell(results: &Results, place: &Path, order: Order<'_>) -> miette::Result<()> {
    let words = || format!("{}\nwritten to {}\n", report::table(results).trim_end(), place.display());
    order.quiet.tell_or(order.json, || to_json(results), words)
}
