//! A place to write in before anything is shown.
//!
//! It lies beside its destination, `.switchback-NAME`, or inside of it, `.switchback-`, where what lies beside it is on another file
//! system or not to be written. So the next run to the same destination finds it: while the process lives that made it, to be
//! refused; else to finish what it began and clear it away.

use super::OutputError;
use super::disk::Disk;
use super::finish::finish;
use super::lock::{Held, Untaken, clear, let_go, remove};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Every staging folder of this process, with the folders that were made for it. Who holds the lock keeps [`abandon`] waiting.
static STAGED: Mutex<BTreeMap<PathBuf, Vec<PathBuf>>> = Mutex::new(BTreeMap::new());

/// What the names of staging folders begin with.
const PREFIX: &str = ".switchback-";

/// A hidden folder that is removed with everything in it when dropped, or by [`abandon`] where the process is stopped.
#[derive(Debug)]
pub(super) struct Staging {
    held: Held,
}

/// While it lives the process is not stopped by a signal.
pub(super) struct Uninterrupted {
    _staged: MutexGuard<'static, BTreeMap<PathBuf, Vec<PathBuf>>>,
}

impl Uninterrupted {
    /// Waits for others who replace files.
    pub(super) fn new() -> Self {
        Self { _staged: staged() }
    }
}

/// Waits until nothing is half replaced, and removes all staging folders. Whoever begins to write while the result lives
/// waits for ever: the process is to end meanwhile.
#[must_use]
pub fn abandon() -> impl Sized {
    let staged = staged();
    staged.iter().for_each(|(path, made)| remove_all(path, made));
    staged
}

/// A thread that panicked while it held the lock left a set of paths all the same.
fn staged() -> MutexGuard<'static, BTreeMap<PathBuf, Vec<PathBuf>>> {
    STAGED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes a staging folder, and those of the folders made for it that nothing came into.
fn remove_all(path: &Path, made: &[PathBuf]) {
    remove(path);
    made.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
}

/// Why there is no place to write in.
#[derive(Debug)]
pub(super) enum Unstaged {
    /// A process that lives writes there.
    Busy(String),
    /// The system refuses.
    Refused(io::Error),
    /// What a process that is dead left cannot be finished.
    Unfinished(OutputError),
}

impl From<Untaken> for Unstaged {
    fn from(why: Untaken) -> Self {
        match why {
            Untaken::Busy(holder) => Self::Busy(holder),
            Untaken::Refused(source) => Self::Refused(source),
        }
    }
}

impl From<io::Error> for Unstaged {
    fn from(source: io::Error) -> Self {
        Self::Refused(source)
    }
}

impl From<OutputError> for Unstaged {
    fn from(error: OutputError) -> Self {
        Self::Unfinished(error)
    }
}

impl Staging {
    /// The place for a destination, whose folder is made where it is not there. What a dead process left is finished first.
    pub(super) fn claim(target: &Path, (disk, forced): (&Disk, bool)) -> Result<(PathBuf, Self), Unstaged> {
        let mut staged = staged();
        let made = make_folders(target.parent().unwrap_or(Path::new("")))?;
        let held = real(target).map_err(Unstaged::from).and_then(|place| {
            let held = hold(&place)?;
            finish(held.path(), &place, (disk, forced))?;
            clear(held.path());
            Ok((place, held))
        });
        match held {
            Ok((place, held)) => {
                clear_away_the_dead(&held, disk);
                staged.insert(held.path().to_owned(), made);
                Ok((place, Self { held }))
            }
            Err(error) => {
                made.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
                Err(error)
            }
        }
    }

    /// The folder.
    pub(super) fn path(&self) -> &Path {
        self.held.path()
    }

    /// A new folder inside this one.
    pub(super) fn folder(&self, name: &str) -> io::Result<PathBuf> {
        let path = self.path().join(name);
        fs::create_dir(&path)?;
        Ok(path)
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        let mut staged = staged();
        let made = staged.get(self.path()).cloned().unwrap_or_default();
        remove_all(self.path(), &made);
        staged.remove(self.path());
    }
}

/// The nearest folder, or what stands in its place, on the way up that exists.
pub(super) fn nearest(target: &Path) -> &Path {
    target
        .ancestors()
        .map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
        .find(|folder| folder.exists())
        .unwrap_or(Path::new("."))
}

/// Makes the folders on the way that are not there: those that were made, the outermost first.
fn make_folders(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let missing: Vec<&Path> =
        folder.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists()).collect();
    let mut made = Vec::new();
    for folder in missing.into_iter().rev() {
        match fs::create_dir(folder) {
            Ok(()) => made.push(folder.to_owned()),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => {
                made.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
                return Err(error);
            }
        }
    }
    Ok(made)
}

/// The path of a destination, which need not be there, in a folder that is, without links.
fn real(target: &Path) -> io::Result<PathBuf> {
    match target.file_name() {
        Some(name) if !target.is_dir() => {
            let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty());
            Ok(fs::canonicalize(parent.unwrap_or(Path::new(".")))?.join(name))
        }
        _ => fs::canonicalize(target),
    }
}

/// Takes the staging folder of a destination. One that is there already tells where it lies.
fn hold(place: &Path) -> Result<Held, Unstaged> {
    let inside = place.join(PREFIX);
    let Some(beside) = beside(place).filter(|_| !inside.is_dir()) else {
        return Ok(Held::take(&inside)?);
    };
    let refuses = |error: &io::Error| {
        matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem)
    };
    match Held::take(&beside) {
        Err(Untaken::Refused(error)) if place.is_dir() && refuses(&error) => Ok(Held::take(&inside)?),
        Ok(held) if place.is_dir() => match is_near(held.path(), place) {
            Ok(true) => Ok(held),
            Ok(false) => {
                let_go(held.path());
                Ok(Held::take(&inside)?)
            }
            Err(error) => {
                let_go(held.path());
                Err(error.into())
            }
        },
        other => Ok(other?),
    }
}

/// Where the staging folder of a destination lies, as a rule.
fn beside(place: &Path) -> Option<PathBuf> {
    let mut name = std::ffi::OsString::from(PREFIX);
    name.push(place.file_name()?);
    Some(place.with_file_name(name))
}

/// The staging folders that a destination may have.
pub(super) fn stagings_of(target: &Path) -> Vec<PathBuf> {
    let place = real(target).unwrap_or_else(|_| target.to_owned());
    beside(&place).into_iter().chain([place.join(PREFIX)]).collect()
}

/// Whether files can be renamed from one folder into another. Where they lie on different file systems the system says so, be
/// there such a file or not.
fn is_near(from: &Path, to: &Path) -> io::Result<bool> {
    #[cfg(unix)]
    rustix::fs::access(to, rustix::fs::Access::WRITE_OK | rustix::fs::Access::EXEC_OK)?;
    match fs::rename(from.join("nothing"), to.join(".switchback-nothing")) {
        Err(error) if error.kind() == io::ErrorKind::CrossesDevices => Ok(false),
        Err(error) if error.kind() == io::ErrorKind::ReadOnlyFilesystem => Err(error),
        _ => Ok(true),
    }
}

/// Finishes and clears away what other dead processes left in the same folder.
fn clear_away_the_dead(held: &Held, disk: &Disk) {
    let folder = held.path().parent().unwrap_or(held.path());
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    for path in entries.filter(|path| path != held.path()) {
        let name = path.file_name().and_then(OsStr::to_str).and_then(|name| name.strip_prefix(PREFIX));
        let Some(name) = name.filter(|name| !name.is_empty()) else { continue };
        let Some(left) = Held::take_of_dead(&path) else { continue };
        if finish(left.path(), &folder.join(name), (disk, false)).is_ok() {
            remove(left.path());
        }
    }
}
