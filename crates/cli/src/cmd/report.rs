//! `switchback report FOLDER`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use miette::Diagnostic;
use std::path::PathBuf;
use switchback_io::output::Artefacts;
use switchback_report::pages::{self, Files, INDEX, Kind};
use switchback_report::study as report;
use thiserror::Error;

/// Draw the page index.html of a report again, from the files in its folder alone: of a study the figures, too. Nothing is simulated.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The folder of a report, as a study, an examination, `gap --out` or `identify --out` wrote it.
    folder: PathBuf,

    /// Write what is drawn into this folder instead; of a study, its tables too. A table of rounded figures asks for it.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    output: Output,
}

/// What is drawn of rounded figures would pass for what a study wrote.
#[derive(Debug, Error, Diagnostic)]
#[error("{}: holds figures rounded to {digits} significant digits, and is not drawn into", folder.display())]
#[diagnostic(help("give another folder: --out DIR"))]
struct Rounded {
    folder: PathBuf,
    digits: u32,
}

/// Reads the files, draws, replaces what was drawn.
///
/// # Errors
/// A folder without a report, with more than one, or of another format; rounded figures without `--out`; or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let files = Files::read(&args.folder)?;
    let (names, artefacts): (&[&str], Artefacts) = match files.kind()? {
        Kind::Study => {
            let results = pages::results(&files)?;
            if let (Some(digits), None) = (results.digits, &args.out) {
                return Err(Rounded { folder: args.folder.clone(), digits }.into());
            }
            if let Some(rounding) = results.rounding() {
                args.output.quiet.describe(&format!("{rounding}\n"))?;
            }
            (&report::FILES, args.threads.install(|| report::artefacts(&results))??)
        }
        Kind::Examination | Kind::Diagnosis | Kind::Identification => {
            let mut page = Artefacts::default();
            page.add(INDEX, pages::index(&files)?);
            (&[INDEX], page)
        }
    };
    let folder = args.out.as_ref().unwrap_or(&args.folder);
    args.output.force.claim(folder, names)?.commit(&artefacts)?;
    args.output.quiet.describe(&format!("written to {}\n", folder.join(INDEX).display()))?;
    Ok(Outcome::Done)
}
