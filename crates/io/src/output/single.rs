//! A file that is asked for by its name.

use super::OutputError;
use super::disk::Disk;
use super::moves::is_there;
use super::staging::{Staging, Uninterrupted, Unstaged, nearest};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A file that has been found writable, to be written in one go.
///
/// As with an [`OutputFolder`](super::OutputFolder) the claim comes before the computation. Whose the file is that stands
/// there already nobody can tell, so that it is replaced only where that is forced.
#[derive(Debug)]
pub struct OutputFile {
    /// As it was given.
    target: PathBuf,
    /// The same without links in its folder.
    place: PathBuf,
    staging: Staging,
    disk: Disk,
}

impl OutputFile {
    /// Makes sure that the file can be written. `inputs` are what the command reads, which it never replaces. Folders that do not exist
    /// are made, and removed again if nothing is written.
    ///
    /// # Errors
    /// [`OutputError`] if something stands there, unless `forced`, if it is an input or its folder a file, if another run writes it, or
    /// the system refuses.
    pub fn claim(target: &Path, forced: bool, inputs: &[&Path]) -> Result<Self, OutputError> {
        Self::claim_on(Disk::default(), target, (forced, inputs))
    }

    fn claim_on(disk: Disk, target: &Path, (forced, inputs): (bool, &[&Path])) -> Result<Self, OutputError> {
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
        let (place, staging) = Staging::claim(target, (&disk, forced)).map_err(|why| match why {
            Unstaged::Busy(holder) => OutputError::Busy { target: shown, holder },
            Unstaged::Refused(source) => OutputError::FileUnwritable { target: shown, source },
            Unstaged::Unfinished(error) => error,
        })?;
        Ok(Self { target: target.to_owned(), place, staging, disk })
    }

    /// Writes it: whole, or not at all.
    ///
    /// # Errors
    /// [`OutputError`] if the system refuses; what was there is there still.
    pub fn commit(self, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
        let _until_done = Uninterrupted::new();
        let write = || -> io::Result<()> {
            let fresh = self.staging.folder("fresh")?.join("file");
            self.disk.write(&fresh, contents.as_ref())?;
            let old = self.staging.path().join("old");
            // Where it cannot have a second name it cannot be brought back.
            let has_old = is_there(&self.place) && self.disk.link(&self.place, &old).is_ok();
            let is_new = !is_there(&self.place);
            self.disk.rename(&fresh, &self.place)?;
            let synced = self.disk.sync_folder(self.place.parent().unwrap_or(&self.place));
            if synced.is_err() && has_old {
                let _ = fs::rename(&old, &self.place);
            } else if synced.is_err() && is_new {
                let _ = fs::remove_file(&self.place);
            }
            synced
        };
        write().map_err(|source| OutputError::FileUnwritable {
            target: self.target.display().to_string(),
            source,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::faults::Faults;
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
        drop(OutputFile::claim(&place, false, &[]).unwrap());
        assert!(!root.path().join("deep").exists());
        OutputFile::claim(&place, false, &[]).unwrap().commit("first").unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "first");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1, "nothing else is left");
        let error = OutputFile::claim(&place.join("below"), false, &[]).unwrap_err();
        assert!(matches!(error, OutputError::NoFolder { .. }), "{error}");
    }

    #[test]
    fn a_call_that_fails_leaves_what_was_there() {
        for old in [Some("old"), None] {
            let mut failures = 0;
            for call in 1..=8 {
                let root = tempdir().unwrap();
                let place = root.path().join("rig.toml");
                old.inspect(|old| fs::write(&place, old).unwrap());
                let disk = Disk::with(Faults { fail: Some(call), ..Faults::default() });
                let written = OutputFile::claim_on(disk, &place, (true, &[])).unwrap().commit("new");
                let now = fs::read_to_string(&place).ok();
                assert_eq!(now.as_deref(), if written.is_ok() { Some("new") } else { old }, "call {call}");
                assert_eq!(fs::read_dir(root.path()).unwrap().count(), usize::from(now.is_some()));
                failures += usize::from(written.is_err());
            }
            // Written, synchronised, renamed, its folder synchronised.
            assert_eq!(failures, 4);
        }
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
