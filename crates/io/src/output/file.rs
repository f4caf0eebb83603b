//! A file that is asked for by its name.

use super::disk::{Disk, is_there};
use super::lock::LockError;
use super::staging::{Staging, obstacle, uninterrupted};
use miette::Diagnostic;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A file that has been found writable, to be written in one step.
///
/// As with an [`OutputFolder`](super::OutputFolder) the claim comes before the computation. Nothing shows who wrote a file that is there
/// already, so it is replaced only by force.
#[derive(Debug)]
pub struct OutputFile {
    target: PathBuf,
    staging: Staging,
    disk: Disk,
}

/// Why a file cannot be written. The first value is the file as given.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum FileError {
    /// The second value, a part of its path, is a file.
    #[error("{0}: cannot be written: {1} is a file, not a folder")]
    #[diagnostic(help("give the path of a file in a folder, existing or new"))]
    NoFolder(String, String),
    /// It is a folder.
    #[error("{0}: is a folder, not a file")]
    #[diagnostic(help("give the name of a file, in this folder or elsewhere"))]
    IsFolder(String),
    /// It is there already.
    #[error("{0}: is there already")]
    #[diagnostic(help("give another name, or --force to replace it"))]
    Exists(String),
    /// The command reads it.
    #[error("{0}: is read by this command, so it cannot be written by it too")]
    #[diagnostic(help("give another name: what was measured is never replaced, with --force or without"))]
    IsInput(String),
    /// The second value, a process, writes it.
    #[error("{0}: {1} is writing there")]
    #[diagnostic(help("wait until it has ended, or give another place"))]
    Busy(String, String),
    /// The system refuses.
    #[error("{0}: cannot write this file: {1}")]
    #[diagnostic(help("give a file in a folder that you may write to, on a disk with space left"))]
    Unwritable(String, #[source] io::Error),
}

impl OutputFile {
    /// Makes sure that the file can be written. `inputs` are the files that the command reads, which it never replaces. Folders that do
    /// not exist are made, and removed again if nothing is written.
    ///
    /// # Errors
    /// [`FileError`] if something is there, unless `forced`, if it is an input or its folder a file, if another run writes it, or the
    /// system refuses.
    pub fn claim(target: &Path, forced: bool, inputs: &[&Path]) -> Result<Self, FileError> {
        Self::claim_on(Disk::default(), target, (forced, inputs))
    }

    fn claim_on(disk: Disk, target: &Path, (forced, inputs): (bool, &[&Path])) -> Result<Self, FileError> {
        let shown = target.display().to_string();
        if target.is_dir() {
            return Err(FileError::IsFolder(shown));
        }
        let is_same = |there: &PathBuf| {
            inputs.iter().any(|input| fs::canonicalize(input).is_ok_and(|input| input == *there))
        };
        if fs::canonicalize(target).as_ref().is_ok_and(is_same) {
            return Err(FileError::IsInput(shown));
        }
        if is_there(target) && !forced {
            return Err(FileError::Exists(shown));
        }
        if let Some(obstacle) = target.parent().and_then(obstacle) {
            return Err(FileError::NoFolder(shown, obstacle.display().to_string()));
        }
        let staging = Staging::claim(target).map_err(|error| match error {
            LockError::Busy(process) => FileError::Busy(shown, process),
            LockError::Refused(source) => FileError::Unwritable(shown, source),
        })?;
        staging.clear();
        Ok(Self { target: target.to_owned(), staging, disk })
    }

    /// Writes the whole file, or nothing.
    ///
    /// # Errors
    /// [`FileError`] if the system refuses; a file that was there is there still.
    pub fn commit(self, contents: impl AsRef<[u8]>) -> Result<(), FileError> {
        let _until_done = uninterrupted();
        let refused = |source| FileError::Unwritable(self.target.display().to_string(), source);
        self.write(contents.as_ref()).map_err(refused)
    }

    fn write(&self, contents: &[u8]) -> io::Result<()> {
        let (place, disk) = (self.staging.place(), &self.disk);
        let [new, old] = ["new", "old"].map(|name| self.staging.folder().join(name));
        disk.write(&new, contents)?;
        let was_there = is_there(place);
        // Where it cannot have a second name it cannot be brought back.
        let _ = if was_there { disk.link(place, &old) } else { Ok(()) };
        disk.rename(&new, place)?;
        let synced = disk.sync_folder(place.parent().unwrap_or(place));
        if synced.is_err() {
            let _ = if was_there { fs::rename(&old, place) } else { fs::remove_file(place) };
        }
        synced
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
        assert!(matches!(error, FileError::Exists(_)), "{error}");
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
        assert!(matches!(error, FileError::NoFolder(..)), "{error}");
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
        assert!(matches!(error, FileError::IsInput(_)), "{error}");
    }

    #[test]
    fn a_folder_is_no_file() {
        let root = tempdir().unwrap();
        let error = OutputFile::claim(root.path(), true, &[]).unwrap_err();
        assert!(matches!(error, FileError::IsFolder(_)), "{error}");
    }
}
