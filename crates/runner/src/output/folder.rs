//! The folder that artefacts go to.

use super::Artefacts;
use super::staging::Staging;
use miette::Diagnostic;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A folder that has been found writable, to be filled in one go.
///
/// [`claim`](Self::claim) comes before the computation, so that a wrong path costs no time; [`commit`](Self::commit)
/// after it. Files are first written whole to a staging folder on the same disk and then renamed into place. A
/// claim that is dropped leaves nothing behind; a commit that fails leaves the folder as it was.
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    staging: Staging,
}

/// Why results could not be written.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum OutputError {
    /// A file stands where a folder is wanted.
    #[error("{target}: cannot be an output folder: {obstacle} is a file")]
    #[diagnostic(help("give the path of a folder, existing or new"))]
    NotAFolder {
        /// The folder as given.
        target: String,
        /// The part of its path that is a file.
        obstacle: String,
    },
    /// A folder stands where a result file is to go.
    #[error("{target}: cannot write the file {name} there: a folder has that name")]
    #[diagnostic(help("move that folder away or give another output folder"))]
    FileIsFolder {
        /// The folder as given.
        target: String,
        /// The artefact's name.
        name: String,
    },
    /// The system refused to write.
    #[error("{target}: cannot write to this output folder: {source}")]
    #[diagnostic(help("give a folder that you may write to, on a disk with space left"))]
    Unwritable {
        /// The folder as given.
        target: String,
        /// What the system said.
        source: io::Error,
    },
}

impl OutputFolder {
    /// Makes sure that the folder can be written: a staging folder is made inside it, or, where it does not exist yet,
    /// inside the nearest folder above it that does.
    ///
    /// # Errors
    /// [`OutputError`] if part of the path is a file or the system refuses.
    pub fn claim(target: &Path) -> Result<Self, OutputError> {
        let shown = target.display().to_string();
        let nearest = target
            .ancestors()
            .map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
            .find(|folder| folder.exists())
            .unwrap_or(Path::new("."));
        if !nearest.is_dir() {
            return Err(OutputError::NotAFolder { target: shown, obstacle: nearest.display().to_string() });
        }
        let staging =
            Staging::inside(nearest).map_err(|source| OutputError::Unwritable { target: shown, source })?;
        Ok(Self { target: target.to_owned(), staging })
    }

    /// The folder, as it was given.
    pub fn path(&self) -> &Path {
        &self.target
    }

    /// Writes all artefacts. Files of the same names are replaced, others are left alone.
    ///
    /// # Errors
    /// [`OutputError`] if the system refuses; the folder then holds what it held before.
    pub fn commit(self, artefacts: &Artefacts) -> Result<(), OutputError> {
        let shown = || self.target.display().to_string();
        if let Some((name, _)) = artefacts.iter().find(|(name, _)| self.target.join(name).is_dir()) {
            return Err(OutputError::FileIsFolder { target: shown(), name: name.to_owned() });
        }
        self.stage_and_rename(artefacts).map_err(|source| OutputError::Unwritable { target: shown(), source })
    }

    fn stage_and_rename(&self, artefacts: &Artefacts) -> io::Result<()> {
        let (fresh, replaced) = (self.staging.folder("fresh")?, self.staging.folder("replaced")?);
        for (name, contents) in artefacts.iter() {
            fs::write(fresh.join(name), contents)?;
        }
        fs::create_dir_all(&self.target)?;
        let mut moved = Vec::new();
        for (name, _) in artefacts.iter() {
            moved.push(name);
            if let Err(error) = exchange(&self.target.join(name), &fresh.join(name), &replaced.join(name)) {
                for name in moved {
                    undo(&self.target.join(name), &replaced.join(name));
                }
                return Err(error);
            }
        }
        Ok(())
    }
}

/// Moves the file at `place`, if any, to `old`, and the one at `new` to `place`.
fn exchange(place: &Path, new: &Path, old: &Path) -> io::Result<()> {
    if place.exists() {
        fs::rename(place, old)?;
    }
    fs::rename(new, place)
}

/// Takes back an exchange as far as it went. Runs after a failure that is reported already, so its own are not.
fn undo(place: &Path, old: &Path) {
    if old.exists() {
        let _ = fs::rename(old, place);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    fn artefacts(files: &[(&str, &str)]) -> Artefacts {
        let mut artefacts = Artefacts::default();
        for (name, contents) in files {
            artefacts.add(*name, *contents);
        }
        artefacts
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_new_folder_appears_with_all_its_files_and_nothing_else() {
        let root = tempdir().unwrap();
        let target = root.path().join("deep/new");
        OutputFolder::claim(&target).unwrap().commit(&artefacts(&[("a", "1"), ("b", "2")])).unwrap();
        assert_eq!(names(&target), ["a", "b"]);
        assert_eq!(names(root.path()), ["deep"]);
    }

    #[test]
    fn files_of_the_same_name_are_replaced_and_others_are_kept() {
        let root = tempdir().unwrap();
        fs::write(root.path().join("a"), "old").unwrap();
        fs::write(root.path().join("other"), "kept").unwrap();
        OutputFolder::claim(root.path()).unwrap().commit(&artefacts(&[("a", "new")])).unwrap();
        assert_eq!(fs::read_to_string(root.path().join("a")).unwrap(), "new");
        assert_eq!(fs::read_to_string(root.path().join("other")).unwrap(), "kept");
        assert_eq!(names(root.path()), ["a", "other"]);
    }

    #[test]
    fn a_dropped_claim_leaves_nothing() {
        let root = tempdir().unwrap();
        drop(OutputFolder::claim(&root.path().join("deep/new")).unwrap());
        assert!(names(root.path()).is_empty());
    }

    #[test]
    fn a_path_below_a_file_is_refused_at_once() {
        let root = tempdir().unwrap();
        let file = root.path().join("file");
        fs::write(&file, "kept").unwrap();
        let error = OutputFolder::claim(&file.join("reports")).unwrap_err();
        assert!(matches!(error, OutputError::NotAFolder { .. }), "{error}");
        assert_eq!(fs::read_to_string(file).unwrap(), "kept");
    }

    #[test]
    fn a_commit_that_cannot_finish_keeps_what_was_there() {
        let root = tempdir().unwrap();
        fs::write(root.path().join("a"), "old").unwrap();
        fs::create_dir(root.path().join("b")).unwrap();
        let claim = OutputFolder::claim(root.path()).unwrap();
        let error = claim.commit(&artefacts(&[("a", "new"), ("b", "new")])).unwrap_err();
        assert!(matches!(error, OutputError::FileIsFolder { .. }), "{error}");
        assert_eq!(fs::read_to_string(root.path().join("a")).unwrap(), "old");
        assert_eq!(names(root.path()), ["a", "b"]);
    }
}
