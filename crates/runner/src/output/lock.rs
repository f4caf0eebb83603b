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

    fn take_within(path: &Path, patience: Duration) -> Result<Self, Untaken> {
        let (start, place) = (Instant::now(), path.join(LOCK));
        loop {
            let is_new = make_folder(path)?;
            let taken = open(&place).map(|file| (file.try_lock(), file));
            let is_late = start.elapsed() >= patience;
            match taken {
                Ok((Ok(()), file)) if is_at(&file, &place) => return Self::signed(path, file),
                // Where the file system knows no locks, a folder is held by whoever made it.
                Ok((Err(TryLockError::Error(_)), file)) if is_new => return Self::signed(path, file),
                Ok((Err(TryLockError::Error(_)), _)) => return Err(Untaken::Busy(holder(&place))),
                Ok((Err(TryLockError::WouldBlock), _)) if is_late => {
                    return Err(Untaken::Busy(holder(&place)));
                }
                Err(error) if is_late || error.kind() != io::ErrorKind::NotFound => return Err(error.into()),
                // Someone is just clearing it away.
                _ => sleep(PATIENCE / 20),
            }
        }
    }

    fn signed(path: &Path, mut lock: File) -> Result<Self, Untaken> {
        let signed = lock.set_len(0).and_then(|()| write!(lock, "{}", std::process::id()));
        if let Err(error) = signed {
            // What a dead process left in it stays.
            let_go(path);
            return Err(error.into());
        }
        Ok(Self { path: path.to_owned(), _lock: lock })
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

/// Removes the lock, and the folder if nothing else is in it.
fn let_go(path: &Path) {
    let _ = fs::remove_file(path.join(LOCK));
    let _ = fs::remove_dir(path);
}

/// Whether the folder was not there before.
fn make_folder(path: &Path) -> io::Result<bool> {
    match fs::create_dir(path) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(error),
    }
}

fn open(place: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).write(true).create(true).truncate(false).open(place)
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
    fn many_take_turns_while_it_comes_and_goes() {
        let root = tempdir().unwrap();
        let path = root.path().join("staging");
        let inside = std::sync::atomic::AtomicUsize::new(0);
        let work = || {
            for _ in 0..50 {
                if let Ok(held) = Held::take(&path) {
                    assert_eq!(inside.fetch_add(1, std::sync::atomic::Ordering::SeqCst), 0, "two hold it");
                    inside.fetch_sub(1, std::sync::atomic::Ordering::SeqCst);
                    remove(held.path());
                }
            }
        };
        std::thread::scope(|scope| (0..4).for_each(|_| drop(scope.spawn(work))));
        assert!(!path.exists());
    }
}
