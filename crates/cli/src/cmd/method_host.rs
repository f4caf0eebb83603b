//! `switchback method-host FOLDER COMMAND…`, the processes that a study with methods of others starts

use crate::failure::{CommandResult, Outcome};
use crate::interrupt::{self, SignalGuard};
use miette::{Diagnostic, IntoDiagnostic};
use std::ffi::OsString;
use std::io;
use std::path::PathBuf;
use switchback_host::{become_command, guard_command};
use thiserror::Error;

/// Run a command that answers line by line, in a process of its own, of which nothing is left.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Become the command, which ends with its parent.
    #[arg(long)]
    inside: bool,

    /// Removed at the end.
    folder: PathBuf,

    #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true)]
    command: Vec<OsString>,
}

/// There is no such command.
#[derive(Debug, Error, Diagnostic)]
#[error("{command} cannot be started: {source}")]
struct NoCommand {
    command: String,
    source: io::Error,
}

/// Runs it.
///
/// # Errors
/// A command that cannot be started.
pub(crate) fn run(args: &Args) -> CommandResult {
    if args.inside {
        let source = become_command(&args.command);
        let command = args.command[0].display().to_string();
        return Err(NoCommand { command, source }.into());
    }
    let _signals_clear_up_first = SignalGuard::new();
    let code = guard_command(&args.command, &args.folder, interrupt::is_wished).into_diagnostic()?;
    Ok(Outcome::Of(code))
}
