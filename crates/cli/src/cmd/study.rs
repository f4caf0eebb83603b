//! `switchback SCENARIO.toml`

use super::consistency::{self, Order};
use super::examination::{self, Page, run_part};
use crate::failure::CommandResult;
use crate::options::{Output, Threads, Yes};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use miette::miette;
use std::path::{Path, PathBuf};
use switchback_lab::examination::{Bases, Examination, design_of, read};
use switchback_study::consistency::least_seconds;
use switchback_study::scenario::{Engine, Scenario};
use switchback_study::{Request, Shard, refuse_other_kinds};

/// Run the study that a scenario file describes, and write its report.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The scenario file.
    // There is none where a verb is named.
    #[arg(required = true)]
    scenario: Option<PathBuf>,

    /// Write the report into this folder [default: reports/NAME, NAME the scenario's file name]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// How replicates are computed, whatever the scenario says: `direct` simulates every cell, slowly, to check `superposed`
    #[arg(long, value_name = "ENGINE", value_parser = PossibleValuesParser::new(Engine::ALL.map(Engine::name)).map(engine))]
    engine: Option<Engine>,

    /// Run one of N equal parts, counted from 1; `switchback merge` makes the report of all of them
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,

    /// Run the part of the next round of a study that asks for a precision: what `switchback merge` wrote of the rounds before
    #[arg(long, value_name = "DIR", requires = "shard")]
    from: Option<PathBuf>,

    /// Print results.json instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    yes: Yes,

    #[command(flatten)]
    output: Output,
}

/// Reads, claims the folder, runs, writes, prints.
///
/// # Errors
/// A scenario that cannot be read or run, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let Some(file) = args.scenario.as_deref() else {
        return Err(miette!("nothing to do; name a scenario file, or see `switchback --help`"));
    };
    refuse_other_kinds(file)?;
    if let Some(design) = design_of(file) {
        refuse_engine_and_rounds(args, design.article_and_name())?;
        let study = read(file)?;
        let bases = Bases::load(&study, args.output.quiet.quiet)?;
        return examined(args, file, &Examination::new(study, &bases));
    }
    let request = Request { engine: args.engine };
    let scenario = request.of(Scenario::read(file)?);
    let parts = args.shard.map_or(1.0, |shard| shard.of as f64);
    args.yes.permit(least_seconds(&scenario) / parts, args.threads, args.output.quiet)?;
    let order = Order {
        file,
        command: &request.command(file),
        out: args.out.as_deref(),
        shard: args.shard,
        from: args.from.as_deref(),
        threads: args.threads,
        json: args.json,
        quiet: args.output.quiet,
        force: args.output.force,
    };
    consistency::run(&scenario, order)
}

/// Runs an examination, or the part of it that is asked for.
fn examined(args: &Args, file: &Path, examination: &Examination<'_>) -> CommandResult {
    let rigs = examination.tickets().len().div_ceil(args.shard.map_or(1, |shard| shard.of));
    args.yes.permit(rigs as f64 * examination.study().design.seconds(), args.threads, args.output.quiet)?;
    let page = Page { json: args.json, quiet: args.output.quiet };
    let order = examination::Order {
        out: args.out.as_deref(),
        force: args.output.force,
        threads: args.threads,
        page,
    };
    match args.shard {
        Some(shard) => run_part(examination, (file, shard), order),
        None => examination::run(examination, order),
    }
}

/// Only a consistency study has engines and rounds.
fn refuse_engine_and_rounds(args: &Args, kind: &str) -> miette::Result<()> {
    let given = [(args.engine.is_some(), "engines", "--engine"), (args.from.is_some(), "rounds", "--from")];
    match (&args.scenario, given.into_iter().find(|(is_given, ..)| *is_given)) {
        (Some(path), Some((_, what, option))) => {
            Err(miette!("{} is {kind}, which has no {what}; leave out {option}", path.display()))
        }
        _ => Ok(()),
    }
}

/// The engine of a name that is one of them.
fn engine(name: String) -> Engine {
    Engine::from_name(&name).unwrap_or(Engine::Superposed)
}
