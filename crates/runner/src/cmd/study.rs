//! `switchback SCENARIO.toml`

use crate::failure::{CommandResult, Outcome};
use crate::output::{OutputFolder, print};
use crate::progress::Meter;
use crate::scenario::{Engine, Scenario};
use crate::{blind, report, study};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use miette::{IntoDiagnostic, miette};
use std::path::{Path, PathBuf};

/// Run the study that a scenario file describes, and write its report.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scenario file.
    scenario: PathBuf,

    /// Write the report into this folder [default: reports/NAME, NAME the scenario's file name]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Worker threads [default: one a core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// How replicates are computed, whatever the scenario says: `direct` simulates every cell, slowly, to check `superposed`
    #[arg(long, value_name = "ENGINE", value_parser = PossibleValuesParser::new(Engine::ALL.map(Engine::name)).map(engine))]
    engine: Option<Engine>,

    /// Neither progress nor table, only errors.
    #[arg(long)]
    quiet: bool,
}

/// Reads, claims the folder, runs, writes, prints.
///
/// # Errors
/// A scenario that cannot be read or run, or a folder that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let workers = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .into_diagnostic()?;
    if blind::is_blind(&args.scenario) {
        if args.engine.is_some() {
            let path = args.scenario.display();
            return Err(miette!("{path} is a blind study, which has no engines; leave out --engine"));
        }
        return workers.install(|| super::blind::run(&args.scenario, args.out.as_deref(), args.quiet));
    }
    let read = Scenario::read(&args.scenario)?;
    let scenario = match args.engine {
        Some(engine) => read.on(engine),
        None => read,
    };
    let default = || Path::new("reports").join(scenario.name());
    let folder = OutputFolder::claim(&args.out.clone().unwrap_or_else(default))?;
    let meter = Meter::new(args.quiet);
    let results = workers.install(|| study::run(&scenario, command(args), &meter));
    meter.finish();
    let results = results.into_diagnostic()?;
    let place = folder.path().display().to_string();
    folder.commit(&workers.install(|| report::artefacts(&results)))?;
    if !args.quiet {
        print(&format!("{}\nwritten to {place}\n", report::table(&results).trim_end()))?;
    }
    Ok(if results.as_expected() { Outcome::Done } else { Outcome::Unmet })
}

/// The command that makes the results again, without the place where this machine keeps the file.
fn command(args: &Args) -> String {
    let name = args.scenario.file_name().unwrap_or_default().to_string_lossy();
    let engine = args.engine.map_or_else(String::new, |engine| format!(" --engine {}", engine.name()));
    format!("switchback {name}{engine}")
}

/// The engine of a name that is one of them.
fn engine(name: String) -> Engine {
    Engine::from_name(&name).unwrap_or(Engine::Superposed)
}
