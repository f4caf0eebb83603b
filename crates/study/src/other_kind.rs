//! Files that are no scenarios.

use miette::Diagnostic;
use std::path::Path;
use switchback_io::input::FileKind;
use switchback_io::output::path_in_shell;
use thiserror::Error;

/// A file of another kind was given.
#[derive(Debug, Error, Diagnostic)]
#[error("{path}: this is {kind}, but a scenario is wanted")]
#[diagnostic(help("{remedy}"))]
pub struct OtherKind {
    path: String,
    kind: &'static str,
    remedy: String,
}

/// Data, rigs and what verbs wrote are reported as such, with the verb that takes them.
///
/// # Errors
/// [`OtherKind`] for any of them.
pub fn refuse_other_kinds(file: &Path) -> Result<(), OtherKind> {
    let path = file.display().to_string();
    let shown = path_in_shell(file);
    let (kind, remedy) = match FileKind::of(file) {
        Some(FileKind::Data) => ("data", format!("`switchback gap {shown}`")),
        Some(FileKind::Rig) => ("a rig", format!("`switchback gap {shown}`")),
        Some(FileKind::Json(kind @ "a model")) => (kind, format!("`switchback simulate {shown} INPUT.csv`")),
        Some(FileKind::Json(kind)) => (kind, "name a scenario file, or see `switchback --help`".to_owned()),
        Some(FileKind::Scenario) | None => return Ok(()),
    };
    Err(OtherKind { path, kind, remedy })
}
