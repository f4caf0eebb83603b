//! One run at a time for each destination: a staging folder belongs to the process that holds the lock in it.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The file that is locked. The system lets go of it when the process ends, however it ends. It holds the process's number.
const LOCK: &str = "lock";

/// Who only clears away what a dead process left is done by then.
const PATIENCE: Duration = Duration::from_millis(100);

/// A staging folder that is this process's until it ends.
#[derive(Debug)]
pub(super) struct Held {
    path: PathBuf,
    _lock: File,
}

/// Why a staging folder is not to be had.
#[derive(Debug)]
pub(super) enum Untaken {
    /// A process that lives holds it: its number, as far as it is known.
    Busy(String),
    /// The system refuses.
    Refused(io::Error),
}

impl From<io::Error> for Untaken {
    fn from(error: io::Error) -> Self {
        Self::Refused(error)
    }
}

impl Held {
    /// Takes a staging folder, made for it or left by a process that is dead, with all that is in it.
    pub(super) fn take(path: &Path) -> Result<Self, Untaken> {
        Self::take_within(path, PATIENCE)
    }

    /// Takes a staging folder that a dead process left, if it is one.
    pub(super) fn take_of_dead(path: &Path) -> Option<Self> {
        if path.join(LOCK).is_file() { Self::take_within(path, Duration::ZERO).ok() } else { None }
    }

    /// Tries until patience ends: who only clears away what a dead process left will be gone.
    fn take_within(path: &Path, patience: Duration) -> Result<Self, Untaken> {
        let start = Instant::now();
        loop {
            let taken = Self::try_take(path);
            let is_passing = match &taken {
                Ok(_) => false,
                Err(Untaken::Busy(_)) => true,
                Err(Untaken::Refused(error)) => {
                    matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::AlreadyExists)
                }
            };
            if !is_passing || start.elapsed() >= patience {
                return taken;
            }
            sleep(PATIENCE / 20);
        }
    }

    fn try_take(path: &Path) -> Result<Self, Untaken> {
        let (is_new, place) = (make_folder(path)?, path.join(LOCK));
        let lock = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&place)?;
        match lock.try_lock() {
            Ok(()) if is_at(&lock, &place) => Ok(Self::signed(path, lock)?),
            Ok(()) => Err(io::Error::from(io::ErrorKind::NotFound).into()),
            Err(TryLockError::WouldBlock) => Err(Untaken::Busy(holder(&place))),
            // Where the file system knows no locks, a folder is held by whoever made it.
            Err(TryLockError::Error(_)) if is_new => Ok(Self::signed(path, lock)?),
            Err(TryLockError::Error(_)) => {
                let (holder, path) = (holder(&place), path.display());
                Err(Untaken::Busy(format!("{holder}, unless it has ended and left {path},")))
            }
        }
    }

    fn signed(path: &Path, mut lock: File) -> io::Result<Self> {
        let signed = lock.set_len(0).and_then(|()| write!(lock, "{}", std::process::id()));
        if signed.is_err() {
            let_go(path);
        }
        signed.map(|()| Self { path: path.to_owned(), _lock: lock })
    }

    /// The folder.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

/// Removes all that is in a staging folder but the lock.
pub(super) fn clear(path: &Path) {
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        if entry.file_name() != LOCK {
            let place = entry.path();
            let _ = fs::remove_dir_all(&place).or_else(|_| fs::remove_file(&place));
        }
    }
}

/// Removes a staging folder, the lock last. Nothing can be done about one that will not go: the next start tries again.
pub(super) fn remove(path: &Path) {
    clear(path);
    let_go(path);
}

/// Removes a staging folder if nothing but the lock is in it: what a dead process left stays for the next start.
pub(super) fn let_go(path: &Path) {
    if !is_filled(path) {
        let _ = fs::remove_file(path.join(LOCK));
        let _ = fs::remove_dir(path);
    }
}

/// Whether the folder was not there before. One that is there is cleared later, so that it must be the program's: it holds a lock, or
/// nothing yet, and no link leads to it.
fn make_folder(path: &Path) -> io::Result<bool> {
    match fs::create_dir(path) {
        Ok(()) => return Ok(true),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        Err(error) => return Err(error),
    }
    let is_link = fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink());
    if is_link || (is_filled(path) && !path.join(LOCK).is_file()) {
        let told = format!("something else uses {}, where it would be prepared", path.display());
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, told));
    }
    Ok(false)
}

/// Whether something besides the lock is in a folder.
fn is_filled(path: &Path) -> bool {
    fs::read_dir(path).is_ok_and(|entries| entries.flatten().any(|entry| entry.file_name() != LOCK))
}

/// Whether a file that was opened at a place is there still: a lock of one that was removed meanwhile holds nobody off.
#[cfg(unix)]
fn is_at(file: &File, place: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |found: fs::Metadata| (found.dev(), found.ino());
    let at_place = fs::metadata(place).map(identity).ok();
    at_place.is_some() && file.metadata().map(identity).ok() == at_place
}

#[cfg(not(unix))]
fn is_at(_file: &File, place: &Path) -> bool {
    place.exists()
}

fn holder(place: &Path) -> String {
    let number = fs::read_to_string(place).unwrap_or_default();
    if number.is_empty() { "another process".to_owned() } else { format!("process {number}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn one_holds_it_and_the_next_has_what_is_left() {
        let root = tempdir().unwrap();
        let path = root.path().join("staging");
        let held = Held::take(&path).unwrap();
        let Err(Untaken::Busy(holder)) = Held::take(&path) else { panic!("two hold it") };
        assert_eq!(holder, format!("process {}", std::process::id()));
        fs::write(path.join("left"), "").unwrap();
        drop(held);
        let again = Held::take(&path).unwrap();
        assert!(path.join("left").exists());
        remove(again.path());
        assert!(!path.exists());
    }

    #[test]
    fn a_folder_of_someone_else_is_left_alone() {
        let root = tempdir().unwrap();
        let path = root.path().join("staging");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("measured"), "").unwrap();
        assert!(matches!(Held::take(&path), Err(Untaken::Refused(_))));
        #[cfg(unix)]
        {
            let link = root.path().join("link");
            std::os::unix::fs::symlink(&path, &link).unwrap();
            fs::write(path.join(LOCK), "").unwrap();
            assert!(matches!(Held::take(&link), Err(Untaken::Refused(_))));
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
                let Ok(held) = Held::take(&path) else { continue };
                assert_eq!(inside.fetch_add(1, SeqCst), 0, "two hold it");
                sleep(Duration::from_micros(200));
                inside.fetch_sub(1, SeqCst);
                turns.fetch_add(1, SeqCst);
                remove(held.path());
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
