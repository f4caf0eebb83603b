//! `switchback merge DIR… --out DIR`

use super::consistency::{self, Order};
use super::examination::{self, Page, conclude};
use crate::build::{BUILD, JUDGING_SOURCES};
use crate::failure::CommandResult;
use crate::options::{Output, Threads};
use miette::Diagnostic;
use std::path::PathBuf;
use switchback_io::output::{sha256, verify};
use switchback_io::provenance::{PROVENANCE_FILE, Provenance};
use switchback_lab::examination::{Examination, Part, Whole, design_of, merged, read};
use switchback_report::examination::report;
use switchback_study::checkpoint::CHECKPOINT_FILE;
use switchback_study::parts::scenario_of;
use thiserror::Error;

/// Make one report of all parts of a study or an examination, the bytes of one run.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folders that `switchback SCENARIO.toml --shard K/N --out DIR` has written.
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,

    /// Write the report into this folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Where a precision is asked for and not reached yet, write what there is into this folder instead; the next round goes on from it
    #[arg(long, value_name = "DIR")]
    next: Option<PathBuf>,

    /// Print results.json instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    output: Output,
}

/// The parts are of another program.
#[derive(Debug, Error, Diagnostic)]
#[error("{folder}: was judged by another version of the program")]
#[diagnostic(help("merge with the version that judged, or run the parts again with this one"))]
pub(crate) struct OtherProgram {
    folder: String,
}

/// Reads the parts, puts them together, scores, writes, prints.
///
/// # Errors
/// Folders that make no whole, or one that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    args.folders.iter().try_for_each(|folder| verify(folder, |name| name != CHECKPOINT_FILE))?;
    let first = scenario_of(&args.folders[0])?;
    if design_of(&first).is_some() {
        return merge(args);
    }
    let order = Order {
        file: &first,
        command: "",
        out: Some(&args.out),
        shard: None,
        from: None,
        threads: Threads::default(),
        json: args.json,
        quiet: args.output.quiet,
        force: args.output.force,
    };
    consistency::merge(&args.folders, args.next.as_deref(), order)
}

/// The same of an examination.
fn merge(args: &Args) -> CommandResult {
    let threads = Threads::default();
    let provenance = Provenance::begin(BUILD, threads.at_once());
    let mut parts: Vec<Part> = Vec::new();
    for folder in &args.folders {
        let part = Part::read(folder)?;
        if part.program() != JUDGING_SOURCES {
            return Err(OtherProgram { folder: folder.display().to_string() }.into());
        }
        parts.push(part);
    }
    let shards = parts.iter().map(|part| part.shard().to_string()).collect();
    let inputs: Vec<PathBuf> = parts.iter().flat_map(Part::inputs).collect();
    let Whole { scenario, keys, cases } = merged(parts)?;
    let examination = Examination::without_bases(read(&scenario)?);
    let page = Page { json: args.json, quiet: args.output.quiet };
    let folder = examination::Order { out: Some(&args.out), force: args.output.force, threads, page }
        .claim(examination.study())?
        .sparing(inputs.iter().map(PathBuf::as_path))?;
    let mut report = report(&examination, &sha256(&keys), &cases);
    report.files.add_beside(PROVENANCE_FILE, provenance.end(shards).text());
    conclude(report, &keys, folder, page)
}
