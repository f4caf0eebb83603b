//! `switchback rerun RESULTS`

use crate::build::BUILD;
use crate::failure::{CommandResult, Outcome};
use crate::options::{Quiet, Threads, Yes};
use crate::progress::Meter;
use miette::IntoDiagnostic;
use serde::Serialize;
use std::path::PathBuf;
use switchback_io::output::stamped;
use switchback_io::provenance::Provenance;
use switchback_study::results::{self, to_json};
use switchback_study::{compare, consistency};

/// Run the study of some results again, from what they say alone, and compare: exit code 1 where they differ.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The results: a results.json or the report folder that holds one.
    results: PathBuf,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    yes: Yes,

    #[command(flatten)]
    quiet: Quiet,
}

#[derive(Serialize)]
struct Page {
    name: String,
    /// Whether every byte of results.json is the same.
    identical: bool,
    /// Whether nothing differs beyond chance.
    agrees: bool,
    /// What was made elsewhere, or by another version.
    differences_of_origin: Vec<String>,
}

/// Reads the results, runs the study in memory, tells what differs.
///
/// # Errors
/// Results that are none, or hold a scenario that this version cannot run.
pub fn run(args: &Args) -> CommandResult {
    let before = results::read(&args.results)?;
    let scenario = before.to_scenario()?;
    args.yes.permit(consistency::least_seconds(&scenario), args.threads, args.quiet)?;
    let meter = Meter::new(args.quiet);
    let after = args.threads.install(|| consistency::run(&scenario, before.command.clone(), &meter))?;
    meter.finish();
    let after = after.into_diagnostic()?;
    let comparison = compare::compare(&before, &after);
    let identical = to_json(&before) == to_json(&after);
    let origins =
        Provenance::begin(BUILD, args.threads.at_once()).differences(&args.results, &before.version);
    let page = Page {
        name: before.name.clone(),
        identical,
        agrees: comparison.agrees(),
        differences_of_origin: origins,
    };
    let words = || {
        let mut text = String::new();
        page.differences_of_origin.iter().for_each(|origin| text += &format!("{origin}\n"));
        if identical {
            text + "reproduced: every byte of results.json is the same\n"
        } else {
            text + &compare::summary(&comparison, &before, &after)
        }
    };
    args.quiet.tell_or(args.json, || stamped("switchback/rerun/1", &page), words)?;
    Ok(if identical { Outcome::Done } else { Outcome::Unmet })
}
