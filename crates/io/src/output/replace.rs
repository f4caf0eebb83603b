//! How a folder takes the place of another.
//!
//! The new files lie whole in `STAGING/ready`. Where folders can be exchanged the two change places in one step, and whoever looks sees
//! the old report or the new one. Files that are not the program's have a second name in the new folder before that; folders of
//! others, and what cannot have two names, move over right after it. The old folder goes with the staging folder.
//!
//! Elsewhere the new folder becomes `STAGING/incoming`, and its files take their places one by one, the list of hashes last. Meanwhile
//! the folder is a mixture, which [`verify`](super::verify) sees by the old list.
//!
//! A failure takes everything back. Of a process that is killed, [`finish`](super::finish) tells by those two names what remains to be done.

use super::disk::{self, Disk};
use super::moves::{Moves, is_there};
use super::written::{Owner, SUMS, Written};
use std::ffi::{OsStr, OsString};
use std::fs;
use std::io;
use std::path::Path;

/// The new folder, whole, or the old one once they are exchanged.
pub(super) const READY: &str = "ready";
/// The new files that have not taken their places yet.
pub(super) const INCOMING: &str = "incoming";
/// The old files, where they go one by one.
const REPLACED: &str = "replaced";
/// A folder that is of no more use.
const DONE: &str = "done";

/// A folder about to be replaced.
#[derive(Debug)]
pub(super) struct Replacement<'a> {
    /// Where the new folder is ready.
    pub(super) staging: &'a Path,
    /// The folder to replace, which need not be there.
    pub(super) target: &'a Path,
    /// Files of a former run that go.
    pub(super) stale: &'a [String],
    /// What renames.
    pub(super) disk: &'a Disk,
}

impl Replacement<'_> {
    /// Replaces the folder.
    ///
    /// # Errors
    /// The system's; the folder is as it was before.
    pub(super) fn run(&self) -> io::Result<()> {
        let ready = self.staging.join(READY);
        if !self.target.exists() {
            return self.appear(&ready);
        }
        let new = names(&ready)?;
        if self.may_be_exchanged(&ready) && self.exchange(&ready)? {
            return Ok(());
        }
        for name in names(&ready)?.iter().filter(|name| !new.contains(name)) {
            fs::remove_file(ready.join(name))?;
        }
        let incoming = self.staging.join(INCOMING);
        fs::rename(&ready, &incoming)?;
        let mut moves = Moves::new(self.disk);
        let moved = self.one_by_one(&incoming, &new, &mut moves);
        if moved.is_err() {
            moves.undo();
            // Nothing remains to be done if the process is killed now.
            let _ = fs::rename(&incoming, self.staging.join(DONE));
        }
        moved
    }

    /// A new folder.
    fn appear(&self, ready: &Path) -> io::Result<()> {
        let mut moves = Moves::new(self.disk);
        let moved = moves
            .rename(ready.to_owned(), self.target.to_owned())
            .and_then(|()| self.disk.sync_folder(parent(self.target)));
        if moved.is_err() {
            moves.undo();
        }
        moved
    }

    /// Whether another folder may come in place of this one: not if the process works in it, whose shell would find itself in a folder
    /// that is gone, nor if it is of another owner or group than a new one.
    fn may_be_exchanged(&self, ready: &Path) -> bool {
        let here = std::env::current_dir().and_then(fs::canonicalize);
        let is_beside = self.staging.parent() == self.target.parent();
        is_beside
            && here.is_ok_and(|here| !here.starts_with(self.target))
            && have_one_owner(ready, self.target)
    }

    /// Exchanges the folders; `Ok(false)`, and both are as they were but for second names in the new one, where that is impossible.
    fn exchange(&self, ready: &Path) -> io::Result<bool> {
        fs::set_permissions(ready, fs::metadata(self.target)?.permissions())?;
        self.link_others(ready)?;
        if !self.disk.exchange(ready, self.target)? {
            return Ok(false);
        }
        let mut moves = Moves::new(self.disk);
        let moved = carry_over(ready, self.target, &mut moves)
            .and_then(|()| self.disk.sync_folder(self.target))
            .and_then(|()| self.disk.sync_folder(parent(self.target)));
        match moved {
            Ok(()) => {
                let _ = fs::rename(ready, self.staging.join(DONE));
                Ok(true)
            }
            Err(error) => {
                moves.undo();
                let _ = disk::exchange(ready, self.target);
                Err(error)
            }
        }
    }

    /// Gives files that stay a second name in the new folder, so that they are never missing.
    fn link_others(&self, ready: &Path) -> io::Result<()> {
        for name in names(self.target)? {
            let (from, to) = (self.target.join(&name), ready.join(&name));
            let is_file = fs::symlink_metadata(&from).is_ok_and(|found| found.is_file());
            if is_file && !is_there(&to) && !self.is_stale(&name) {
                // Where it cannot be done the file moves over later.
                let _ = self.disk.link(&from, &to);
            }
        }
        Ok(())
    }

    fn is_stale(&self, name: &OsStr) -> bool {
        self.stale.iter().any(|stale| stale.as_str() == name)
    }

    /// Files take their places, stale ones go, the list comes last.
    fn one_by_one(&self, incoming: &Path, new: &[OsString], moves: &mut Moves<'_>) -> io::Result<()> {
        let replaced = self.staging.join(REPLACED);
        fs::create_dir(&replaced)?;
        let leave = |name: &OsStr, moves: &mut Moves<'_>| match self.target.join(name) {
            place if is_there(&place) => moves.rename(place, replaced.join(name)),
            _ => Ok(()),
        };
        for name in new.iter().filter(|name| *name != SUMS) {
            leave(name, moves)?;
            moves.rename(incoming.join(name), self.target.join(name))?;
        }
        for name in self.stale {
            leave(name.as_ref(), moves)?;
        }
        self.disk.sync_folder(self.target)?;
        leave(SUMS.as_ref(), moves)?;
        moves.rename(incoming.join(SUMS), self.target.join(SUMS))?;
        self.disk.sync_folder(self.target)
    }
}

/// Moves from an old folder to the new one what the new one lacks and no run has replaced or dropped.
pub(super) fn carry_over(old: &Path, new: &Path, moves: &mut Moves<'_>) -> io::Result<()> {
    let (old_list, new_list) = (Written::in_folder(old)?, Written::in_folder(new)?);
    for name in names(old)? {
        let is_dropped = name.to_str().is_some_and(|name| {
            old_list.lists(name)
                && !new_list.lists(name)
                && matches!(old_list.owner(old, name), Ok(Owner::Program))
        });
        if !is_dropped && !is_there(&new.join(&name)) {
            moves.rename(old.join(&name), new.join(&name))?;
        }
    }
    Ok(())
}

/// Names of all that is in a folder, in order.
pub(super) fn names(folder: &Path) -> io::Result<Vec<OsString>> {
    let mut names: Vec<OsString> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect::<io::Result<_>>()?;
    names.sort_unstable();
    Ok(names)
}

fn parent(folder: &Path) -> &Path {
    folder.parent().unwrap_or(folder)
}

#[cfg(unix)]
fn have_one_owner(one: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let owner = |folder: &Path| fs::metadata(folder).map(|found| (found.uid(), found.gid())).ok();
    owner(one).is_some() && owner(one) == owner(other)
}

#[cfg(not(unix))]
fn have_one_owner(_one: &Path, _other: &Path) -> bool {
    true
}
