//! A file that is asked for by its name.

use super::OutputError;
use super::staging::{Staging, Uninterrupted};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A file that has been found writable, to be written in one go.
///
/// As with an [`OutputFolder`](super::OutputFolder) the claim comes before the computation. Whose the file is that stands
/// there already nobody can tell, so that it is replaced only where that is forced.
#[derive(Debug)]
pub struct OutputFile {
    target: PathBuf,
    staging: Staging,
}

impl OutputFile {
    /// Makes sure that the file can be written into a folder that exists.
    ///
    /// # Errors
    /// [`OutputError`] if something stands there, unless `forced`, or the system refuses.
    pub fn claim(target: &Path, forced: bool) -> Result<Self, OutputError> {
        let shown = target.display().to_string();
        if target.is_dir() {
            return Err(OutputError::IsFolder { target: shown });
        }
        if fs::symlink_metadata(target).is_ok() && !forced {
            return Err(OutputError::Exists { target: shown });
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
        let staging = Staging::inside(folder.unwrap_or(Path::new(".")))
            .map_err(|source| OutputError::Unwritable { target: shown, source })?;
        Ok(Self { target: target.to_owned(), staging })
    }

    /// Writes it: whole, or not at all.
    ///
    /// # Errors
    /// [`OutputError`] if the system refuses; what was there is there still.
    pub fn commit(self, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
        let _until_done = Uninterrupted::new();
        let write = || -> io::Result<()> {
            let fresh = self.staging.folder("fresh")?.join("file");
            fs::write(&fresh, contents)?;
            fs::rename(&fresh, &self.target)
        };
        write()
            .map_err(|source| OutputError::Unwritable { target: self.target.display().to_string(), source })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn a_file_that_stands_there_is_replaced_only_by_force() {
        let root = tempdir().unwrap();
        let place = root.path().join("rig.toml");
        OutputFile::claim(&place, false).unwrap().commit("first").unwrap();
        let error = OutputFile::claim(&place, false).unwrap_err();
        assert!(matches!(error, OutputError::Exists { .. }), "{error}");
        assert_eq!(fs::read_to_string(&place).unwrap(), "first");
        OutputFile::claim(&place, true).unwrap().commit("second").unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "second");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1, "nothing else is left");
    }

    #[test]
    fn a_folder_is_no_file() {
        let root = tempdir().unwrap();
        let error = OutputFile::claim(root.path(), true).unwrap_err();
        assert!(matches!(error, OutputError::IsFolder { .. }), "{error}");
    }
}
