//! A place to write in before anything is shown.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A hidden folder that is removed with everything in it when dropped.
#[derive(Debug)]
pub(super) struct Staging {
    path: PathBuf,
}

impl Staging {
    /// A new folder inside `parent`, with a name that no running program uses.
    pub(super) fn inside(parent: &Path) -> io::Result<Self> {
        let process = std::process::id();
        let mut attempt = 0;
        loop {
            let path = parent.join(format!(".switchback-{process}-{attempt}"));
            match fs::create_dir(&path) {
                Ok(()) => return Ok(Self { path }),
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

impl Drop for Staging {
    fn drop(&mut self) {
        // Nothing can be done about a folder that will not go, and the results do not depend on it.
        let _ = fs::remove_dir_all(&self.path);
    }
}
