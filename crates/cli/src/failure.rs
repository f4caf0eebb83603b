//! How a command ends, and how a failure is reported.

use miette::Diagnostic;
use std::process::ExitCode;
use switchback_io::output::{note, plain};

/// How a command ended that was given good input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub(crate) enum Outcome {
    /// All done; exit code 0.
    Done,
    /// What was expected did not come out, or what was compared differs; exit code 1.
    Unmet,
    /// Part of it is done and kept, and the rest is to be asked for; exit code 3.
    Stopped,
    /// As another process did, whose exit code is passed on.
    Of(u8),
}

/// Exit code of a process that a signal stopped: what was finished is kept.
pub(crate) const STOPPED: u8 = 3;

/// What every command returns: an outcome, or the report of an input that could not be used (exit code 2).
pub(crate) type CommandResult = Result<Outcome, miette::Report>;

/// Shows a failure on stderr and turns the result into the process's exit code: 0, 1, 2 or 3.
pub(crate) fn exit_code(result: CommandResult) -> ExitCode {
    let code = match result {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::Unmet) => 1,
        Ok(Outcome::Stopped) => STOPPED,
        Ok(Outcome::Of(code)) => code,
        Err(report) => {
            let diagnostic: &dyn Diagnostic = report.as_ref();
            note(&format!("{}\n", plain(diagnostic).trim_end()));
            2
        }
    };
    code.into()
}
