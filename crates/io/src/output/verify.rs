//! The check that a folder's files are those of one run.

use super::hash_list::{HashList, Owner};
use super::staging::{is_unfinished, stagings_of};
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
    /// The list of its files cannot be read.
    #[error(
        "{folder}: its list of hashes, .switchback.sha256 or .switchback.beside.sha256, cannot be read: {why}"
    )]
    #[diagnostic(help(
        "remove what is there in its place, and run the command that writes this folder again"
    ))]
    NoList {
        /// The folder as given.
        folder: String,
        /// What the system said.
        why: String,
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

/// Makes sure that those files of a folder that are to be checked are of one run, as far as their list of hashes shows; a folder without a list is
/// accepted as it is.
///
/// # Errors
/// [`NotWhole`] if files were changed or are missing, or the folder was being replaced when a process was killed.
pub fn verify(folder: &Path, is_checked: impl Fn(&str) -> bool) -> Result<(), NotWhole> {
    let shown = folder.display().to_string();
    if stagings_of(folder).iter().any(|staging| is_unfinished(staging)) {
        return Err(NotWhole::Unfinished { folder: shown });
    }
    let unreadable = |why: std::io::Error| NotWhole::NoList { folder: shown.clone(), why: why.to_string() };
    let list = HashList::in_folder(folder).map_err(unreadable)?;
    let fault = |name: &str| match list.owner(folder, name) {
        _ if !folder.join(name).exists() => Some(format!("{name} is missing")),
        Ok(Owner::Program) => None,
        _ => Some(format!("{name} has changed")),
    };
    let faults: Vec<String> = list.names().filter(|name| is_checked(name)).filter_map(fault).collect();
    let more = match faults.len() {
        0 => return Ok(()),
        1..=NAMED => String::new(),
        count => format!(", and {} more", count - NAMED),
    };
    let named = &faults[..faults.len().min(NAMED)];
    Err(NotWhole::Changed { folder: shown, files: named.join(", ") + &more })
}
