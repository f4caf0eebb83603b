//! `switchback report FOLDER`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use std::path::PathBuf;
use switchback_io::output::Artefacts;
use switchback_report::pages::{self, Files, INDEX, Kind};
use switchback_report::study as report;

/// Draw the page index.html of a report again, from the files in its folder alone: of a study the figures, too. Nothing is simulated.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The folder of a report, as a study, an examination, `gap --out` or `identify --out` wrote it.
    folder: PathBuf,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    output: Output,
}

/// Reads the files, draws, replaces what was drawn.
///
/// # Errors
/// A folder without a report, with more than one, or of another format; or one that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let files = Files::read(&args.folder)?;
    let (names, artefacts): (&[&str], Artefacts) = match files.kind()? {
        Kind::Study => {
            let results = pages::results(&files)?;
            (&report::FILES, args.threads.install(|| report::artefacts(&results))??)
        }
        Kind::Examination | Kind::Diagnosis | Kind::Identification => {
            let mut page = Artefacts::default();
            page.add(INDEX, pages::index(&files)?);
            (&[INDEX], page)
        }
    };
    args.output.force.claim(&args.folder, names)?.commit(&artefacts)?;
    args.output.quiet.describe(&format!("written to {}\n", args.folder.join(INDEX).display()))?;
    Ok(Outcome::Done)
}
