//! `switchback fmu-host JOB.json`, the process that `gap --fmu` starts

use crate::failure::{CommandResult, Outcome};
use std::path::PathBuf;
use switchback_io::fmu;

/// Run the library of an FMU over the inputs of a job, and report it in a file beside that.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    job: PathBuf,
}

/// Runs it.
///
/// # Errors
/// A job that is none, or a file that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    fmu::host(&args.job)?;
    Ok(Outcome::Done)
}
