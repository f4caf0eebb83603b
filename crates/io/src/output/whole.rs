//! Whether a folder holds what one run wrote.

use super::finish::is_unfinished;
use super::staging::stagings_of;
use super::written::{Owner, Written};
use miette::Diagnostic;
use std::path::Path;
use thiserror::Error;

/// Why a folder is not as one run wrote it.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum NotWhole {
    /// Its files were being replaced when the process was killed, or are so now.
    #[error("{folder}: is half replaced: a run was killed while it wrote there, or writes there still")]
    #[diagnostic(help("run the command that writes this folder again: it first finishes what was begun"))]
    Unfinished {
        /// The folder as given.
        folder: String,
    },
    /// Its files do not match their list of hashes.
    #[error("{folder}: is not as it was written: {files}")]
    #[diagnostic(help(
        "run the command that writes this folder again, with --force if it asks for that; a results.json that you know to be good can be named itself"
    ))]
    Changed {
        /// The folder as given.
        folder: String,
        /// The files, with what is wrong with them.
        files: String,
    },
}

/// How many files are named.
const NAMED: usize = 3;

/// Makes sure that a folder's files are those of one run, as far as their list of hashes tells; a folder without a list is taken as it is.
///
/// # Errors
/// [`NotWhole`] if files were changed or are missing, or the folder was being replaced when a process was killed.
pub fn verify(folder: &Path) -> Result<(), NotWhole> {
    verify_but(folder, &[])
}

/// The same but for some files, which hold a hash of their own and are checked when they are read.
///
/// # Errors
/// As [`verify`].
pub fn verify_but(folder: &Path, others: &[&str]) -> Result<(), NotWhole> {
    checked(folder, |_| true, others)
}

/// The same of the files whose names are wanted.
///
/// # Errors
/// As [`verify`].
pub fn verify_those(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> Result<(), NotWhole> {
    checked(folder, is_wanted, &[])
}

fn checked(folder: &Path, is_wanted: impl Fn(&str) -> bool, others: &[&str]) -> Result<(), NotWhole> {
    let shown = || folder.display().to_string();
    if stagings_of(folder).iter().any(|staging| is_unfinished(staging)) {
        return Err(NotWhole::Unfinished { folder: shown() });
    }
    let list = Written::in_folder(folder).unwrap_or_default();
    let is_as_written =
        |name: &str| others.contains(&name) || matches!(list.owner(folder, name), Ok(Owner::Program));
    let wrong = |name: &str| match folder.join(name).exists() {
        false => Some(format!("{name} is missing")),
        true => (!is_as_written(name)).then(|| format!("{name} has changed")),
    };
    let mut wrong: Vec<String> = list.names().filter(|name| is_wanted(name)).filter_map(wrong).collect();
    if wrong.is_empty() {
        return Ok(());
    }
    let more = wrong.len().saturating_sub(NAMED);
    wrong.truncate(NAMED);
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    Err(NotWhole::Changed { folder: shown(), files: wrong.join(", ") + &more })
}
