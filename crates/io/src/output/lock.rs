//! One run at a time for each destination.

use crate::input::own;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};
use thiserror::Error;

/// The file that is locked, in the staging folder of a destination. It contains the number of the process, and the system unlocks it
/// when the process ends, however it ends.
const LOCK: &str = "lock";

/// A process that only removes an abandoned folder unlocks it within this time.
const PATIENCE: Duration = Duration::from_millis(100);

/// A folder that belongs to this process until it ends.
#[derive(Debug)]
pub(super) struct Lock {
    folder: PathBuf,
    _file: File,
}

/// Why a folder cannot be locked.
#[derive(Debug, Error)]
pub(super) enum LockError {
    /// A living process has locked it: its number, as far as it is known.
    #[error("{0} is writing there")]
    Busy(String),
    /// The system refuses.
    #[error(transparent)]
    Refused(#[from] io::Error),
}

impl Lock {
    /// Locks a folder, made for it or left by a process that was killed, with everything in it.
    pub(super) fn take(folder: &Path) -> Result<Self, LockError> {
        let start = Instant::now();
        loop {
            match Self::try_take(folder) {
                Err(error) if is_passing(&error) && start.elapsed() < PATIENCE => sleep(PATIENCE / 20),
                taken => return taken,
            }
        }
    }

    /// Locks a folder that a killed process left, if it is one.
    pub(super) fn take_abandoned(folder: &Path) -> Option<Self> {
        if folder.join(LOCK).is_file() { Self::try_take(folder).ok() } else { None }
    }

    fn try_take(folder: &Path) -> Result<Self, LockError> {
        let (is_new, place) = (make(folder)?, folder.join(LOCK));
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&place)?;
        match file.try_lock() {
            Ok(()) if !is_at(&file, &place) => return Err(io::Error::from(io::ErrorKind::NotFound).into()),
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(LockError::Busy(process(&place))),
            // Where the file system has no locks, a folder belongs to the process that made it.
            Err(TryLockError::Error(_)) if is_new => {}
            Err(TryLockError::Error(_)) => {
                let (process, folder) = (process(&place), folder.display());
                return Err(LockError::Busy(format!("{process}, unless it has ended and left {folder},")));
            }
        }
        if let Err(error) = file.set_len(0).and_then(|()| write!(file, "{}", std::process::id())) {
            remove_empty(folder);
            return Err(error.into());
        }
        Ok(Self { folder: folder.to_owned(), _file: file })
    }

    /// The folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }
}

/// Removes everything in a locked folder but the lock.
pub(super) fn clear(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name() != LOCK {
            let place = entry.path();
            let _ = fs::remove_dir_all(&place).or_else(|_| fs::remove_file(&place));
        }
    }
}

/// Removes a locked folder if only the lock is in it. A failure is not reported: the next run tries again.
pub(super) fn remove_empty(folder: &Path) {
    if !is_filled(folder) {
        let _ = fs::remove_file(folder.join(LOCK));
        let _ = fs::remove_dir(folder);
    }
}

/// Whether the next attempt may succeed, because another process locks or removes the folder at this moment.
fn is_passing(error: &LockError) -> bool {
    match error {
        LockError::Busy(_) => true,
        LockError::Refused(error) => {
            matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::AlreadyExists)
        }
    }
}

/// Makes the folder, if it is not there. One that is there will be cleared, so it must be the program's: it contains a lock, or nothing
/// yet, and is no link.
fn make(folder: &Path) -> io::Result<bool> {
    match fs::create_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        made => return made.map(|()| true),
    }
    if folder.is_symlink() || (is_filled(folder) && !folder.join(LOCK).is_file()) {
        let words = format!("something else uses {}, where it would be prepared", folder.display());
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, words));
    }
    Ok(false)
}

/// Whether something besides the lock is in a folder.
fn is_filled(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|entries| entries.flatten().any(|entry| entry.file_name() != LOCK))
}

/// Whether a file that was opened at a place is there still: the lock of a file that was removed meanwhile excludes nobody.
#[cfg(unix)]
fn is_at(file: &File, place: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |found: fs::Metadata| (found.dev(), found.ino());
    let there = fs::metadata(place).map(identity).ok();
    there.is_some() && file.metadata().map(identity).ok() == there
}

#[cfg(not(unix))]
fn is_at(_file: &File, place: &Path) -> bool {
    place.exists()
}

/// The process that wrote its number into a lock.
fn process(place: &Path) -> String {
    let number = own(place).ok().and_then(|number| String::from_utf8(number).ok()).unwrap_or_default();
    if number.is_empty() { "another process".to_owned() } else { format!("process {number}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    fn remove(folder: &Path) {
        clear(folder);
        remove_empty(folder);
    }

    #[test]
    fn one_locks_it_and_the_next_has_what_is_left() {
        let root = tempdir().unwrap();
        let path = root.path().join("staging");
        let lock = Lock::take(&path).unwrap();
        let Err(LockError::Busy(process)) = Lock::take(&path) else { panic!("two have locked it") };
        assert_eq!(process, format!("process {}", std::process::id()));
        fs::write(path.join("left"), "").unwrap();
        drop(lock);
        let again = Lock::take(&path).unwrap();
        assert!(path.join("left").exists());
        remove(again.folder());
        assert!(!path.exists());
    }

    #[test]
    fn a_folder_of_someone_else_is_left_alone() {
        let root = tempdir().unwrap();
        let path = root.path().join("staging");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("measured"), "").unwrap();
        assert!(matches!(Lock::take(&path), Err(LockError::Refused(_))));
        #[cfg(unix)]
        {
            let link = root.path().join("link");
            std::os::unix::fs::symlink(&path, &link).unwrap();
            fs::write(path.join(LOCK), "").unwrap();
            assert!(matches!(Lock::take(&link), Err(LockError::Refused(_))));
        }
        assert!(path.join("measured").exists());
    }

    #[test]
    fn many_take_turns_while_it_comes_and_goes() {
        use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
        let root = tempdir().unwrap();
        let path = root.path().join("staging");
        let (inside, turns) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let work = || {
            for _ in 0..30 {
                let Ok(lock) = Lock::take(&path) else { continue };
                assert_eq!(inside.fetch_add(1, SeqCst), 0, "two have locked it");
                sleep(Duration::from_micros(200));
                inside.fetch_sub(1, SeqCst);
                turns.fetch_add(1, SeqCst);
                remove(lock.folder());
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(work);
            }
        });
        assert!(turns.into_inner() >= 30);
        assert!(!path.exists());
    }
}
