//! How a command ends, and how a failure is told.

use miette::{Diagnostic, GraphicalReportHandler};
use std::fmt::Write;
use std::io::IsTerminal;
use std::process::ExitCode;

/// How a command ended that was given good input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub enum Outcome {
    /// All done; exit code 0.
    Done,
    /// What was expected did not come out, or what was compared differs; exit code 1.
    Unmet,
}

/// What every command returns: an outcome, or the report of an input that could not be used (exit code 2).
pub type CommandResult = Result<Outcome, miette::Report>;

/// Tells a failure on stderr and turns the result into the process's exit code: 0, 1 or 2.
pub fn exit_code(result: CommandResult) -> ExitCode {
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Unmet) => ExitCode::from(1),
        Err(report) => {
            let diagnostic: &dyn Diagnostic = report.as_ref();
            let told = if std::io::stderr().is_terminal() { framed(diagnostic) } else { plain(diagnostic) };
            eprintln!("{}", told.trim_end());
            ExitCode::from(2)
        }
    }
}

/// The picture for a terminal: colours and a frame around the offending lines.
fn framed(diagnostic: &dyn Diagnostic) -> String {
    let mut told = String::new();
    match GraphicalReportHandler::new().render_report(&mut told, diagnostic) {
        Ok(()) => told,
        Err(_) => plain(diagnostic),
    }
}

/// The same everywhere else, without colours or widths: the message, the offending line with the place marked, the remedy.
///
/// ```text
/// error: rig.toml:3:1: unknown key `oder`, expected one of …
///   3 | oder = 2
///     | ^^^^
/// help: did you mean `order`?
/// ```
pub fn plain(diagnostic: &dyn Diagnostic) -> String {
    let mut told = format!("error: {diagnostic}\n");
    if let (Some(code), Some(label)) =
        (diagnostic.source_code(), diagnostic.labels().and_then(|mut l| l.next()))
        && let Ok(contents) = code.read_span(label.inner(), 0, 0)
        && let Ok(text) = std::str::from_utf8(contents.data())
    {
        let number = (contents.line() + 1).to_string();
        let line = text.lines().next().unwrap_or_default();
        let prefix: String =
            line.chars().take(contents.column()).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
        let marks =
            "^".repeat(label.len().clamp(1, line.chars().count().saturating_sub(contents.column()).max(1)));
        let _ =
            writeln!(told, "  {number} | {line}\n  {:width$} | {prefix}{marks}", "", width = number.len());
    }
    if let Some(help) = diagnostic.help() {
        let _ = writeln!(told, "help: {help}");
    }
    told
}
