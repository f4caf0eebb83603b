//! How a command ends, and how a failure is told.

use miette::{Diagnostic, GraphicalReportHandler, SourceCode, SourceSpan};
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

/// Exit code of a process that a signal stopped: what was finished is kept.
pub const STOPPED: i32 = 3;

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
///
/// Where several things are wrong, each follows in this form, numbered.
pub fn plain(diagnostic: &dyn Diagnostic) -> String {
    let mut told = format!("error: {}", told(diagnostic));
    for (k, related) in diagnostic.related().into_iter().flatten().enumerate() {
        let _ = write!(told, "{}. {}", k + 1, self::told(related));
    }
    told
}

/// One message with its place and remedy.
fn told(diagnostic: &dyn Diagnostic) -> String {
    let mut told = format!("{diagnostic}\n");
    if let (Some(code), Some(label)) =
        (diagnostic.source_code(), diagnostic.labels().and_then(|mut l| l.next()))
    {
        told.push_str(&marked_line(code, label.inner()).unwrap_or_default());
    }
    if let Some(help) = diagnostic.help() {
        let _ = writeln!(told, "help: {help}");
    }
    told
}

/// The line that a span begins on, with its number before it and marks under the span.
fn marked_line(code: &dyn SourceCode, span: &SourceSpan) -> Option<String> {
    // A line of context on each side makes sure that the span's own line is there in full.
    let contents = code.read_span(span, 1, 1).ok()?;
    let text = std::str::from_utf8(contents.data()).ok()?;
    let start = span.offset().checked_sub(contents.span().offset())?;
    let before = text.get(..start)?;
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[line_start..].lines().next().unwrap_or_default();
    let number = (contents.line() + 1 + before.matches('\n').count()).to_string();
    let blanks: String = before[line_start..].chars().map(|c| if c == '\t' { c } else { ' ' }).collect();
    let marked = text[start..].chars().take_while(|c| *c != '\n').count().min(span.len()).max(1);
    Some(format!(
        "  {number} | {line}\n  {:width$} | {blanks}{}\n",
        "",
        "^".repeat(marked),
        width = number.len()
    ))
}
