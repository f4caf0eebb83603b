//! The folder in which files are written before anything is shown.
//!
//! It lies beside its destination, `.switchback-NAME`, or inside it, `.switchback-`, where the folder around the destination is on
//! another file system or cannot be written. So the next run to the same destination finds it: it is refused while the process lives
//! that made the folder, and otherwise finishes a replacement that was begun and removes the folder.

use super::disk::is_there;
use super::hash_list::SUMS;
use super::lock::{self, Lock, LockError};
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The new folder, whole; the old one after the two are exchanged.
pub(super) const READY: &str = "ready";

/// The new files that have not taken their places yet, where they do so one by one.
pub(super) const INCOMING: &str = "incoming";

/// The beginning of the names of staging folders.
const PREFIX: &str = ".switchback-";

/// Every staging folder of this process, with the folders that were made for it.
static STAGED: Mutex<Staged> = Mutex::new(Staged::new());

type Staged = BTreeMap<PathBuf, Vec<PathBuf>>;

/// A hidden folder that is removed when dropped, or by [`abandon`] where the process is stopped.
#[derive(Debug)]
pub(super) struct Staging {
    place: PathBuf,
    lock: Lock,
}

/// While the result lives, no signal stops the process and nobody else of it replaces files.
#[must_use]
pub(super) fn uninterrupted() -> impl Sized {
    staged()
}

/// Waits until nothing is half replaced, and removes all staging folders. Anyone who begins to write while the result lives waits for
/// ever: the process is to end meanwhile.
#[must_use]
pub fn abandon() -> impl Sized {
    let staged = staged();
    staged.iter().for_each(|(folder, made)| remove(folder, made));
    staged
}

/// A thread that panicked while it used the list left a list all the same.
fn staged() -> MutexGuard<'static, Staged> {
    STAGED.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Staging {
    /// The staging folder of a destination, whose parents are made where they are not there. Those of killed processes beside it are
    /// removed.
    pub(super) fn claim(target: &Path) -> Result<Self, LockError> {
        let mut staged = staged();
        let parent = target.parent().unwrap_or(Path::new(""));
        let made: Vec<PathBuf> =
            parent.ancestors().filter(|folder| !is_there(folder)).map(Path::to_owned).collect();
        let claim = || {
            fs::create_dir_all(parent)?;
            let place = without_links(target)?;
            let lock = lock(&place)?;
            Ok(Self { place, lock })
        };
        let claimed = claim();
        match &claimed {
            Ok(staging) => {
                remove_abandoned(staging.folder());
                staged.insert(staging.folder().to_owned(), made);
            }
            Err(_) => remove_folders(&made),
        }
        claimed
    }

    /// The destination, without links.
    pub(super) fn place(&self) -> &Path {
        &self.place
    }

    /// The staging folder.
    pub(super) fn folder(&self) -> &Path {
        self.lock.folder()
    }

    /// Removes everything that a killed process left in it.
    pub(super) fn clear(&self) {
        lock::clear(self.folder());
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        let mut staged = staged();
        let made = staged.remove(self.folder()).unwrap_or_default();
        remove(self.folder(), &made);
    }
}

/// The staging folders that a destination may have: beside it, and inside it.
pub(super) fn stagings_of(target: &Path) -> [PathBuf; 2] {
    let place = without_links(target).unwrap_or_else(|_| target.to_owned());
    let mut name = OsString::from(PREFIX);
    name.push(place.file_name().unwrap_or_default());
    [place.with_file_name(name), place.join(PREFIX)]
}

/// Whether the folder that a staging folder is for is a mixture of old and new files.
pub(super) fn is_unfinished(staging: &Path) -> bool {
    is_there(&staging.join(INCOMING).join(SUMS))
}

/// The first that is there of a path and the folders around it, unless it is a folder.
pub(super) fn obstacle(folder: &Path) -> Option<&Path> {
    folder.ancestors().find(|part| is_there(part)).filter(|part| !part.is_dir())
}

/// Removes a staging folder, unless the next run to its destination needs the files in it, and those of the folders made for it that
/// are empty.
fn remove(folder: &Path, made: &[PathBuf]) {
    if !is_there(&folder.join(READY)) && !is_unfinished(folder) {
        lock::clear(folder);
    }
    lock::remove_empty(folder);
    remove_folders(made);
}

/// Removes folders that are empty, the innermost first.
fn remove_folders(made: &[PathBuf]) {
    made.iter().for_each(|folder| drop(fs::remove_dir(folder)));
}

/// Removes the staging folders that killed processes left beside this one.
fn remove_abandoned(staging: &Path) {
    let beside = staging.parent().map(fs::read_dir).into_iter().flatten().flatten().flatten();
    for folder in beside.map(|entry| entry.path()).filter(|folder| folder != staging) {
        let name = folder.file_name().and_then(OsStr::to_str).unwrap_or_default();
        if name.starts_with(PREFIX)
            && name != PREFIX
            && let Some(lock) = Lock::take_abandoned(&folder)
        {
            remove(lock.folder(), &[]);
        }
    }
}

/// The path of a destination, which need not be there, in a folder that is.
fn without_links(target: &Path) -> io::Result<PathBuf> {
    match target.file_name() {
        Some(name) if !target.is_dir() => {
            let parent = target.parent().unwrap_or(Path::new(""));
            Ok(fs::canonicalize(Path::new(".").join(parent))?.join(name))
        }
        _ => fs::canonicalize(target),
    }
}

/// Locks the staging folder of a destination: the one inside it, where that is there or the one beside it is impossible.
fn lock(place: &Path) -> Result<Lock, LockError> {
    let [beside, inside] = stagings_of(place);
    if !place.is_dir() {
        return Lock::take(&beside);
    }
    let _may_be_written = tempfile::tempfile_in(place)?;
    if inside.is_dir() {
        return Lock::take(&inside);
    }
    match Lock::take(&beside) {
        Ok(lock) if is_near(&beside, place) => Ok(lock),
        Ok(lock) => {
            remove(lock.folder(), &[]);
            Lock::take(&inside)
        }
        Err(LockError::Refused(_)) => Lock::take(&inside),
        busy => busy,
    }
}

/// Whether files can be renamed from one folder into another. Where the two lie on different file systems the system says so even
/// of a file that is not there.
fn is_near(from: &Path, to: &Path) -> bool {
    let renamed = fs::rename(from.join("nothing"), to.join(".switchback-nothing"));
    renamed.is_err_and(|error| error.kind() != io::ErrorKind::CrossesDevices)
}
