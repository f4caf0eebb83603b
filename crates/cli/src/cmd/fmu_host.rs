//! `switchback fmu-host FMU`, the processes that `gap --fmu` starts

use crate::failure::{CommandResult, Outcome};
use crate::interrupt::{self, SignalGuard};
use miette::IntoDiagnostic;
use std::path::PathBuf;
use switchback_host::{guard, simulate};

/// Run an FMU over the inputs that come by standard input, in a process and a folder of their own, of which nothing is left.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    fmu: PathBuf,

    /// Run it in this process, and unpack it into the working folder.
    #[arg(long)]
    inside: bool,
}

/// Runs it.
///
/// # Errors
/// Inputs that are none, or a system that refuses a process or a folder.
pub(crate) fn run(args: &Args) -> CommandResult {
    if args.inside {
        simulate(&args.fmu).into_diagnostic()?;
        return Ok(Outcome::Done);
    }
    let _signals_clear_up_first = SignalGuard::new();
    let code = guard(&args.fmu, interrupt::is_wished).into_diagnostic()?;
    Ok(Outcome::Of(code))
}
