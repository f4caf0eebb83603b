//! `switchback compare BASELINE NEW`

use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use std::path::PathBuf;
use switchback_io::output::Artefacts;
use switchback_report::plots;
use switchback_study::compare::{self, Comparison};
use switchback_study::results::{self, Results};

/// Compare two results in units of their Monte-Carlo errors; exit code 1 where they differ beyond chance.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The results to compare with: a results.json, a results.json.gz, or the report folder that holds one.
    baseline: PathBuf,

    /// The results to judge.
    new: PathBuf,

    /// Also write comparison.txt, comparison.svg and overlays of the curves into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    output: Output,
}

/// What the folder gets.
const FILES: [&str; 3] = ["comparison.txt", "comparison.svg", "overlay-*.svg"];

/// Reads both, compares, prints, and writes the folder if one was asked for.
///
/// # Errors
/// Files that are no results, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let baseline = results::read(&args.baseline)?;
    let new = results::read(&args.new)?;
    let folder =
        args.output.force.claim_if_asked(args.out.as_deref(), &FILES, &[&args.baseline, &args.new])?;
    let comparison = compare::compare(&baseline, &new);
    let summary = compare::summary(&comparison, &baseline, &new);
    if let Some(folder) = folder {
        folder.commit(&artefacts(&comparison, &summary, (&baseline, &new)))?;
    }
    args.output.quiet.describe_or(
        args.json,
        || compare::json(&comparison, &baseline, &new),
        || summary.clone(),
    )?;
    Ok(if comparison.agrees() { Outcome::Done } else { Outcome::Unmet })
}

fn artefacts(comparison: &Comparison, summary: &str, (baseline, new): (&Results, &Results)) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add("comparison.txt", summary);
    let title = format!("{}: new results against the baseline", baseline.name);
    artefacts.add("comparison.svg", plots::quantiles(comparison, &title));
    for figure in plots::overlays(baseline, new) {
        artefacts.add(format!("overlay-{}", figure.name), figure.svg);
    }
    artefacts
}
