//! What remains to be done for a process that was killed while it replaced a folder.

use super::OutputError;
use super::disk::Disk;
use super::moves::{Moves, is_there};
use super::replace::{INCOMING, READY, carry_over, names};
use super::written::{Owner, SUMS, Written, is_list};
use std::fs;
use std::io;
use std::path::Path;

/// Whether the folder that a staging folder is for is a mixture of old and new files.
pub(super) fn is_unfinished(staging: &Path) -> bool {
    is_there(&staging.join(INCOMING).join(SUMS))
}

/// Finishes it: after this nothing in the staging folder is of use to anyone. Files that somebody changed in the meantime are replaced
/// only by force.
///
/// # Errors
/// [`OutputError`] if there are such files, or the system refuses; what remains to be done can still be done.
pub(super) fn finish(
    staging: &Path,
    target: &Path,
    (disk, forced): (&Disk, bool),
) -> Result<(), OutputError> {
    let unwritable = |source| OutputError::Unwritable { target: target.display().to_string(), source };
    let (incoming, ready) = (staging.join(INCOMING), staging.join(READY));
    if is_unfinished(staging) {
        refuse_changes(&incoming, target, forced)?;
        bring_in(&incoming, target, disk).map_err(unwritable)?;
    }
    if ready.is_dir() && target.is_dir() {
        carry_over(&ready, target, &mut Moves::new(disk)).map_err(unwritable)?;
    }
    Ok(())
}

/// The files that have not taken their places do, stale ones go, the list comes last.
fn bring_in(incoming: &Path, target: &Path, disk: &Disk) -> io::Result<()> {
    fs::create_dir_all(target)?;
    let (old, new) = (Written::in_folder(target)?, Written::in_folder(incoming)?);
    for name in names(incoming)?.iter().filter(|name| *name != SUMS) {
        disk.rename(&incoming.join(name), &target.join(name))?;
    }
    for name in old.names().chain(old.beside()).filter(|name| !new.lists(name)) {
        let place = target.join(name);
        if is_there(&place) && old.owner(target, name)? == Owner::Program {
            fs::remove_file(place)?;
        }
    }
    disk.sync_folder(target)?;
    disk.rename(&incoming.join(SUMS), &target.join(SUMS))?;
    disk.sync_folder(target)
}

/// The run that was killed had made sure that nothing of anyone else would be lost.
fn refuse_changes(incoming: &Path, target: &Path, forced: bool) -> Result<(), OutputError> {
    let shown = || target.display().to_string();
    let unwritable = |source| OutputError::Unwritable { target: shown(), source };
    let old = Written::in_folder(target).map_err(unwritable)?;
    let mut changed = Vec::new();
    for name in names(incoming).map_err(unwritable)? {
        let name = name.to_string_lossy().into_owned();
        if !is_list(&name) && old.owner(target, &name).map_err(unwritable)? != Owner::Program {
            changed.push(name);
        }
    }
    if changed.is_empty() || forced {
        return Ok(());
    }
    let files = format!("a run was killed while it replaced this folder; {}", changed.join(", "));
    Err(OutputError::Foreign { target: shown(), files })
}
