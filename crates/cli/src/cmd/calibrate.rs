//! `switchback calibrate DIR… --out VERDICT.json`

use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use miette::Diagnostic;
use schemars::Schema;
use std::path::{Path, PathBuf};
use switchback_diagnose::fitted::{CalibrateError, FittedVerdict};
use switchback_io::output::{stamped, stamped_schema};
use switchback_lab::examination::{Case, Design, Part, design_of, read_cases};
use switchback_lab::training::calibrated;
use switchback_study::parts::{PART_FILE, scenario_of};
use thiserror::Error;

/// Fit the verdict on records that nobody designed to rigs whose cause is known.
///
/// What it reaches is reported beside what rules reach: every rig is predicted from rigs with another base and another law.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folders of field examinations, or of parts of them: `switchback SCENARIO.toml --shard K/N --out DIR`.
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,

    /// Write the verdict into this file: coefficients, the range of what was met, and where it comes from.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    #[command(flatten)]
    output: Output,
}

/// Name and version of the layout of a fitted verdict.
const SCHEMA: &str = "switchback/verdict/1";

/// The JSON Schema of a fitted verdict.
pub(crate) fn schema() -> Schema {
    stamped_schema::<FittedVerdict>(SCHEMA)
}

/// Rigs that no verdict can be fitted to.
#[derive(Debug, Error, Diagnostic)]
#[error("{folders}: {source}")]
#[diagnostic(help(
    "add parts of a field examination with made rigs without fault, known faults and foreign ones"
))]
struct TooFew {
    folders: String,
    source: CalibrateError,
}

/// Folders that no examples can be taken from.
#[derive(Debug, Error, Diagnostic)]
enum FolderError {
    /// It holds something else.
    #[error("{0}: holds no judged rigs of a field examination")]
    #[diagnostic(help(
        "give folders that `switchback scenarios/calibrate-field.toml --shard K/N --out DIR` has written to its end"
    ))]
    NoField(String),
    /// The same rigs would count twice.
    #[error("{0}: `{1}` is among the folders already")]
    #[diagnostic(help("give every part once"))]
    Twice(String, String),
}

/// The rigs of a folder, and which part of what they are.
fn judged(folder: &Path) -> miette::Result<(String, Vec<Case>)> {
    let no_field = || FolderError::NoField(folder.display().to_string());
    if folder.join(PART_FILE).is_file() {
        if design_of(&scenario_of(folder)?) != Some(Design::Field) {
            return Err(no_field().into());
        }
        let part = Part::read(folder)?;
        return Ok((part.title(), part.cases().to_vec()));
    }
    if !folder.join("cases.jsonl").is_file() {
        return Err(no_field().into());
    }
    let name = folder.file_name().unwrap_or_default();
    Ok((name.to_string_lossy().into_owned(), read_cases(folder)?))
}

/// Reads what was judged, fits, shows, writes.
///
/// # Errors
/// Folders without judged rigs, too few of these, or a file that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let out = args.output.force.claim_file(args.out.as_deref(), &[])?;
    let (mut cases, mut studies) = (Vec::new(), Vec::new());
    for folder in &args.folders {
        let (study, found) = judged(folder)?;
        if studies.contains(&study) {
            return Err(FolderError::Twice(folder.display().to_string(), study).into());
        }
        studies.push(study);
        cases.extend(found);
    }
    let calibrated = calibrated(&cases, ("switchback calibrate", &studies)).map_err(|source| TooFew {
        folders: args.folders.iter().map(|f| f.display().to_string()).collect::<Vec<_>>().join(", "),
        source,
    })?;
    if let Some(out) = out {
        out.commit(stamped(SCHEMA, &calibrated.verdict))?;
    }
    args.output.quiet.describe(&calibrated.summary())?;
    Ok(Outcome::Done)
}
