//! The replacement of a folder by another.
//!
//! The new files lie whole in `STAGING/ready`. Where folders can be exchanged the two change places in one step, so that a reader sees
//! the old report or the new one. Files that stay have a second name in the new folder before that; folders of others, and files that
//! cannot have two names, move over right after it. The old folder is removed with the staging folder.
//!
//! Elsewhere the new folder becomes `STAGING/incoming`, and its files take their places one by one, the list of hashes last. Meanwhile
//! the folder is a mixture, which [`verify`](super::verify()) recognises by the old list.
//!
//! A failure undoes everything. After a kill [`finish`] recognises by those two names the part that is still to be done.

use super::disk::{Disk, is_there};
use super::hash_list::{HashList, Owner, SUMS};
use super::moves::Moves;
use super::staging::{INCOMING, READY, is_unfinished};
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::Path;

/// The old files, where they leave one by one.
const REPLACED: &str = "replaced";

/// A folder of no more use.
const DONE: &str = "done";

/// Puts the folder that is ready in the place of another, which need not be there.
///
/// # Errors
/// The system's; the folder is as it was before.
pub(super) fn replace(staging: &Path, target: &Path, disk: &Disk) -> io::Result<()> {
    let mut moves = Moves::new(disk);
    let replaced = move_in(staging, target, (disk, &mut moves));
    if replaced.is_err() {
        moves.undo();
    }
    // Nothing remains to be done after a kill from here on.
    for name in [READY, INCOMING] {
        let _ = fs::rename(staging.join(name), staging.join(DONE));
    }
    replaced
}

/// Finishes the replacement that a killed process began: after this nothing in the staging folder is of use.
///
/// # Errors
/// The system's; the rest can still be done.
pub(super) fn finish(staging: &Path, target: &Path, disk: &Disk) -> io::Result<()> {
    let (mut moves, ready) = (Moves::new(disk), staging.join(READY));
    if target.is_dir() && is_unfinished(staging) {
        one_by_one(staging, target, (disk, &mut moves))?;
    }
    if target.is_dir() && ready.is_dir() {
        carry_over(&ready, target, &mut moves)?;
    }
    Ok(())
}

/// Names of the files that have not taken their places when a replacement was killed.
///
/// # Errors
/// The system's.
pub(super) fn unfinished(staging: &Path) -> io::Result<Vec<String>> {
    let names = if is_unfinished(staging) { names(&staging.join(INCOMING))? } else { Vec::new() };
    Ok(names.iter().map(|name| name.to_string_lossy().into_owned()).collect())
}

fn move_in(staging: &Path, target: &Path, (disk, moves): (&Disk, &mut Moves<'_>)) -> io::Result<()> {
    let ready = staging.join(READY);
    let parent = target.parent().unwrap_or(target);
    if !target.exists() {
        moves.rename(&ready, target)?;
        return disk.sync_folder(parent);
    }
    if may_be_exchanged(staging, target) {
        fs::set_permissions(&ready, fs::metadata(target)?.permissions())?;
        let linked = link_others(target, &ready, disk)?;
        if moves.exchange(&ready, target)? {
            carry_over(&ready, target, moves)?;
            disk.sync_folder(target)?;
            return disk.sync_folder(parent);
        }
        for name in linked {
            fs::remove_file(ready.join(name))?;
        }
    }
    fs::rename(&ready, staging.join(INCOMING))?;
    one_by_one(staging, target, (disk, moves))
}

/// Whether another folder may come in place of this one: not if the process works in it, whose shell would then be in a folder that
/// was removed, nor if it is of another owner or group than a new one.
fn may_be_exchanged(staging: &Path, target: &Path) -> bool {
    let here = std::env::current_dir().and_then(fs::canonicalize);
    staging.parent() == target.parent()
        && here.is_ok_and(|here| !here.starts_with(target))
        && have_one_owner(&staging.join(READY), target)
}

/// Gives files that stay a second name in the new folder, so that they are never missing: the names of these files.
fn link_others(old: &Path, new: &Path, disk: &Disk) -> io::Result<Vec<OsString>> {
    let [_, mut staying] = absent(old, new)?;
    staying.retain(|name| {
        let is_file = fs::symlink_metadata(old.join(name)).is_ok_and(|found| found.is_file());
        // Where it cannot be done the file moves over later.
        is_file && disk.link(&old.join(name), &new.join(name)).is_ok()
    });
    Ok(staying)
}

/// Moves from an old folder to the new one everything that stays and is not there yet.
fn carry_over(old: &Path, new: &Path, moves: &mut Moves<'_>) -> io::Result<()> {
    let [_, staying] = absent(old, new)?;
    staying.iter().try_for_each(|name| moves.rename(&old.join(name), &new.join(name)))
}

/// New files take their places, those that the new list drops leave, the list comes last.
fn one_by_one(staging: &Path, target: &Path, (disk, moves): (&Disk, &mut Moves<'_>)) -> io::Result<()> {
    let (incoming, replaced) = (staging.join(INCOMING), staging.join(REPLACED));
    fs::create_dir_all(&replaced)?;
    let [dropped, _] = absent(target, &incoming)?;
    let leave = |name: &OsString, moves: &mut Moves<'_>| match target.join(name) {
        place if is_there(&place) => moves.rename(&place, &replaced.join(name)),
        _ => Ok(()),
    };
    let enter = |name: &OsString, moves: &mut Moves<'_>| {
        leave(name, moves)?;
        moves.rename(&incoming.join(name), &target.join(name))
    };
    for name in names(&incoming)?.iter().filter(|name| *name != SUMS) {
        enter(name, moves)?;
    }
    for name in &dropped {
        leave(name, moves)?;
    }
    disk.sync_folder(target)?;
    enter(&SUMS.into(), moves)?;
    disk.sync_folder(target)
}

/// Names that are in an old folder and not in a new one: first the program's own unchanged files that the new list does not name any
/// more, which are dropped, then all others, which stay.
fn absent(old: &Path, new: &Path) -> io::Result<[Vec<OsString>; 2]> {
    let (old_list, new_list) = (HashList::in_folder(old)?, HashList::in_folder(new)?);
    let is_own = |name: &str| matches!(old_list.owner(old, name), Ok(Owner::Program));
    let is_dropped = |name: &str| old_list.lists(name) && !new_list.lists(name) && is_own(name);
    let absent = names(old)?.into_iter().filter(|name| !is_there(&new.join(name)));
    Ok(<[_; 2]>::from(absent.partition(|name| name.to_str().is_some_and(is_dropped))))
}

/// Names of everything in a folder, in order.
fn names(folder: &Path) -> io::Result<Vec<OsString>> {
    let mut names: Vec<OsString> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.file_name())).collect::<io::Result<_>>()?;
    names.sort_unstable();
    Ok(names)
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
