//! A file that is asked for by its name.

use super::OutputError;
use super::staging::{Staging, Uninterrupted, nearest};
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
    /// Makes sure that the file can be written. `inputs` are what the command reads, which it never replaces. Folders that do not exist
    /// are made when it is written.
    ///
    /// # Errors
    /// [`OutputError`] if something stands there, unless `forced`, if it is an input or its folder a file, or the system refuses.
    pub fn claim(target: &Path, forced: bool, inputs: &[&Path]) -> Result<Self, OutputError> {
        let shown = target.display().to_string();
        if target.is_dir() {
            return Err(OutputError::IsFolder { target: shown });
        }
        let is_same =
            |there: &PathBuf| inputs.iter().any(|input| fs::canonicalize(input).ok().as_ref() == Some(there));
        if fs::canonicalize(target).as_ref().is_ok_and(is_same) {
            return Err(OutputError::IsInput { target: shown });
        }
        if fs::symlink_metadata(target).is_ok() && !forced {
            return Err(OutputError::Exists { target: shown });
        }
        let nearest = nearest(target.parent().unwrap_or(Path::new("")));
        if !nearest.is_dir() {
            return Err(OutputError::NoFolder { target: shown, obstacle: nearest.display().to_string() });
        }
        let staging = Staging::inside(nearest)
            .map_err(|source| OutputError::FileUnwritable { target: shown, source })?;
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
            if let Some(folder) = self.target.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::rename(&fresh, &self.target)
        };
        write().map_err(|source| OutputError::FileUnwritable {
            target: self.target.display().to_string(),
            source,
        })
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
        OutputFile::claim(&place, false, &[]).unwrap().commit("first").unwrap();
        let error = OutputFile::claim(&place, false, &[]).unwrap_err();
        assert!(matches!(error, OutputError::Exists { .. }), "{error}");
        assert_eq!(fs::read_to_string(&place).unwrap(), "first");
        OutputFile::claim(&place, true, &[]).unwrap().commit("second").unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "second");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1, "nothing else is left");
    }

    #[test]
    fn folders_of_a_new_file_are_made_with_it() {
        let root = tempdir().unwrap();
        let place = root.path().join("deep/down/rig.toml");
        let file = OutputFile::claim(&place, false, &[]).unwrap();
        assert!(!root.path().join("deep").exists());
        file.commit("first").unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "first");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1, "nothing else is left");
        let error = OutputFile::claim(&place.join("below"), false, &[]).unwrap_err();
        assert!(matches!(error, OutputError::NoFolder { .. }), "{error}");
    }

    #[test]
    fn what_is_read_is_never_written() {
        let root = tempdir().unwrap();
        let place = root.path().join("measured.csv");
        fs::write(&place, "measured").unwrap();
        let other_name = root.path().join("./measured.csv");
        let error = OutputFile::claim(&other_name, true, &[&place]).unwrap_err();
        assert!(matches!(error, OutputError::IsInput { .. }), "{error}");
    }

    #[test]
    fn a_folder_is_no_file() {
        let root = tempdir().unwrap();
        let error = OutputFile::claim(root.path(), true, &[]).unwrap_err();
        assert!(matches!(error, OutputError::IsFolder { .. }), "{error}");
    }
}
