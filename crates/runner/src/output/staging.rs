//! A place to write in before anything is shown.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Every staging folder of this process. Who holds the lock keeps [`abandon`] waiting.
static STAGED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A hidden folder that is removed with everything in it when dropped, or by [`abandon`] where the process is stopped.
#[derive(Debug)]
pub(super) struct Staging {
    path: PathBuf,
}

/// While it lives the process is not stopped by a signal.
pub(super) struct Uninterrupted {
    _staged: MutexGuard<'static, BTreeSet<PathBuf>>,
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
pub(crate) fn abandon() -> impl Sized {
    let staged = staged();
    for path in staged.iter() {
        let _ = fs::remove_dir_all(path);
    }
    staged
}

/// A thread that panicked while it held the lock left a set of paths all the same.
fn staged() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    STAGED.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Staging {
    /// A new folder inside `parent`, with a name that no running program uses.
    pub(super) fn inside(parent: &Path) -> io::Result<Self> {
        let process = std::process::id();
        let mut attempt = 0;
        let mut staged = staged();
        loop {
            let path = parent.join(format!(".switchback-{process}-{attempt}"));
            match fs::create_dir(&path) {
                Ok(()) => {
                    staged.insert(path.clone());
                    return Ok(Self { path });
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => attempt += 1,
                Err(error) => return Err(error),
            }
        }
    }

    /// A new folder inside this one.
    pub(super) fn folder(&self, name: &str) -> io::Result<PathBuf> {
        let path = self.path.join(name);
        fs::create_dir(&path)?;
        Ok(path)
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

impl Drop for Staging {
    fn drop(&mut self) {
        // Nothing can be done about a folder that will not go, and the results do not depend on it.
        let _ = fs::remove_dir_all(&self.path);
        staged().remove(&self.path);
    }
}
