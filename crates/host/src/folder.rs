//! Folders for a while, which nobody else reads.

use std::fs::File;
use std::io;
use std::path::Path;

/// How the names of such folders begin.
const PREFIX: &str = "switchback-";

/// Attempts at a folder that no other process takes for a left one before it is locked.
const ATTEMPTS: usize = 8;

/// A folder in the one for temporary files. It is locked as long as this process lives; one without a lock was left behind by a process that was
/// killed, and is removed when the next is made.
#[derive(Debug)]
pub(crate) struct PrivateFolder {
    folder: tempfile::TempDir,
    _lock: Option<File>,
}

impl PrivateFolder {
    /// A new folder, whose name says what it is for.
    ///
    /// # Errors
    /// If the system refuses.
    pub(crate) fn new(purpose: &str) -> io::Result<Self> {
        sweep();
        let mut folder = made(purpose)?;
        for _ in 0..ATTEMPTS {
            match lock(folder.path()) {
                Ok(lock) => return Ok(Self { folder, _lock: Some(lock) }),
                Err(_) if !folder.path().exists() => folder = made(purpose)?,
                // There are no locks: nobody removes it.
                Err(_) => break,
            }
        }
        Ok(Self { folder, _lock: None })
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Removes it.
    ///
    /// # Errors
    /// If the system refuses.
    pub(crate) fn close(self) -> io::Result<()> {
        self.folder.close()
    }
}

/// Removes what killed processes of this user left.
pub(crate) fn sweep() {
    let entries = std::fs::read_dir(std::env::temp_dir()).into_iter().flatten().flatten();
    let is_ours =
        |name: &str| ["fmu-", "method-"].iter().any(|purpose| name.starts_with(&[PREFIX, purpose].concat()));
    for entry in entries.filter(|entry| entry.file_name().to_str().is_some_and(is_ours)) {
        let path = entry.path();
        // What somebody else owns, or a living process has locked, is not ours to remove.
        if let Ok(_lock) = lock(&path) {
            let _where_it_is_gone = std::fs::remove_dir_all(&path);
        }
    }
}

fn made(purpose: &str) -> io::Result<tempfile::TempDir> {
    let prefix = format!("{PREFIX}{purpose}-");
    let mut named = tempfile::Builder::new();
    named.prefix(&prefix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        named.permissions(std::fs::Permissions::from_mode(0o700)).tempdir()
    }
    #[cfg(not(unix))]
    named.tempdir()
}

/// Locks a folder of this user, no link to one, that is still in its place.
#[cfg(unix)]
fn lock(path: &Path) -> io::Result<File> {
    use rustix::fs::OFlags;
    use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
    let only = (OFlags::DIRECTORY | OFlags::NOFOLLOW).bits().cast_signed();
    let folder = std::fs::OpenOptions::new().read(true).custom_flags(only).open(path)?;
    let found = folder.metadata()?;
    if found.uid() != rustix::process::geteuid().as_raw() {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    folder.try_lock().map_err(io::Error::from)?;
    // Another may have removed it in between.
    let there = path.symlink_metadata()?;
    if (there.dev(), there.ino()) == (found.dev(), found.ino()) {
        Ok(folder)
    } else {
        Err(io::ErrorKind::NotFound.into())
    }
}

/// Elsewhere folders cannot be locked, and none is removed.
#[cfg(not(unix))]
fn lock(_path: &Path) -> io::Result<File> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_locked_is_kept_and_one_that_was_left_is_removed() {
        let kept = PrivateFolder::new("fmu").expect("a folder");
        let left = made("fmu").expect("a folder").keep();
        let other = tempfile::Builder::new().prefix("switchback-of-others-").tempdir().expect("a folder");
        std::fs::create_dir_all(left.join("a/b")).expect("a folder");
        let link = std::env::temp_dir().join(format!("switchback-fmu-link-{}", std::process::id()));
        std::os::unix::fs::symlink(other.path(), &link).expect("a link");
        sweep();
        assert!(kept.path().exists() && !left.exists() && other.path().exists());
        assert!(link.symlink_metadata().is_ok());
        std::fs::remove_file(link).expect("ours");
        let place = kept.path().to_owned();
        kept.close().expect("ours");
        assert!(!place.exists());
    }
}
