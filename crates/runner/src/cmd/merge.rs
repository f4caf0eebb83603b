//! `switchback merge DIR… --out DIR`

use super::blind::{JUDGING_SOURCES, Page, Place, conclude};
use crate::blind::{Part, merged};
use crate::failure::CommandResult;
use crate::options::{Force, Quiet};
use miette::Diagnostic;
use std::path::PathBuf;
use thiserror::Error;

/// Make one report of all parts of an examination, the bytes of one run.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folders that `switchback SCENARIO.toml --shard K/N --out DIR` has written.
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,

    /// Write the report into this folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Print results.json instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    quiet: Quiet,

    #[command(flatten)]
    force: Force,
}

/// The parts are of another program.
#[derive(Debug, Error, Diagnostic)]
#[error("{folder}: was judged by another version of the program")]
#[diagnostic(help("merge with the version that judged, or run the parts again with this one"))]
pub struct OtherProgram {
    folder: String,
}

/// Reads the parts, puts them together, scores, writes, prints.
///
/// # Errors
/// Folders that make no whole, or one that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let mut parts = Vec::new();
    for folder in &args.folders {
        let part = Part::read(folder)?;
        if part.program() != JUDGING_SOURCES {
            return Err(OtherProgram { folder: folder.display().to_string() }.into());
        }
        parts.push(part);
    }
    let (study, keys, cases) = merged(parts)?;
    let place = Place { out: Some(&args.out), force: args.force };
    conclude(&study, &keys, &cases, place, Page { json: args.json, quiet: args.quiet })
}
