//! The folder that artefacts go to.

use super::Artefacts;
use super::staging::{Staging, Uninterrupted};
use super::written::{Owner, SUMS, Written};
use miette::Diagnostic;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A folder that has been found writable, to be filled in one go.
///
/// [`claim`](Self::claim) comes before the computation, so that a wrong path costs no time; [`commit`](Self::commit)
/// after it. Files are first written whole to a staging folder on the same disk and then renamed into place. A
/// claim that is dropped leaves nothing behind; a commit that fails leaves the folder as it was, and a signal waits until it is done.
///
/// Only files that the program wrote itself are replaced. It knows them by a hidden list beside them, `.switchback.sha256`, of names
/// and SHA-256: a file that is not listed there was written by someone else, and one whose hash differs was changed by
/// someone else. Both are refused unless the folder is [`forced`](Self::forced), at once where the names are known
/// ([`expecting`](Self::expecting)), else on commit. `sha256sum -c .switchback.sha256` checks a folder by the same list.
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    staging: Staging,
    forced: bool,
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
    /// A folder stands where a file is wanted.
    #[error("{target}: is a folder, not a file")]
    #[diagnostic(help("give the name of a file, in this folder or elsewhere"))]
    IsFolder {
        /// The file as given.
        target: String,
    },
    /// A file stands already where one is to be written.
    #[error("{target}: is there already")]
    #[diagnostic(help("give another name, or --force to replace it"))]
    Exists {
        /// The file as given.
        target: String,
    },
    /// A file that someone else wrote or changed would be replaced.
    #[error("{target}: {files} would be lost there")]
    #[diagnostic(help("give another folder, or --force to replace what is there"))]
    Foreign {
        /// The folder as given.
        target: String,
        /// The files with what makes them someone else's.
        files: String,
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
        Ok(Self { target: target.to_owned(), staging, forced: false })
    }

    /// Whether files that someone else wrote or changed may be replaced; not so unless it is said.
    pub fn forced(self, forced: bool) -> Self {
        Self { forced, ..self }
    }

    /// Makes sure that files of these names can be written; for names that are known before the computation.
    ///
    /// # Errors
    /// [`OutputError`] if a file of such a name is someone else's, or a folder has the name.
    pub fn expecting<'a>(self, names: impl IntoIterator<Item = &'a str>) -> Result<Self, OutputError> {
        self.refuse_what_is_not_ours(names)?;
        Ok(self)
    }

    /// The folder, as it was given.
    pub fn path(&self) -> &Path {
        &self.target
    }

    /// Writes all artefacts. The program's own files of the same names are replaced, others are left alone.
    ///
    /// # Errors
    /// [`OutputError`] if a file of such a name is someone else's, or the system refuses; the folder then holds what it held before.
    pub fn commit(self, artefacts: &Artefacts) -> Result<(), OutputError> {
        let _until_done = Uninterrupted::new();
        let written = self.refuse_what_is_not_ours(artefacts.iter().map(|(name, _)| name))?;
        let mut files = artefacts.clone();
        files.add(SUMS, written.with(artefacts).text());
        self.stage_and_rename(&files).map_err(|source| self.unwritable(source))
    }

    /// The list of the program's own files, if every file of these names is one of them.
    fn refuse_what_is_not_ours<'a>(
        &self,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<Written, OutputError> {
        let target = || self.target.display().to_string();
        let written = Written::in_folder(&self.target).map_err(|source| self.unwritable(source))?;
        let mut foreign = Vec::new();
        for name in names {
            if self.target.join(name).is_dir() {
                return Err(OutputError::FileIsFolder { target: target(), name: name.to_owned() });
            }
            match written.owner(&self.target, name).map_err(|source| self.unwritable(source))? {
                Owner::Program => {}
                Owner::Editor => foreign.push(format!("{name} (changed since it was written)")),
                Owner::Stranger => foreign.push(format!("{name} (not written by this program)")),
            }
        }
        if foreign.is_empty() || self.forced {
            return Ok(written);
        }
        Err(OutputError::Foreign { target: target(), files: foreign.join(", ") })
    }

    fn unwritable(&self, source: io::Error) -> OutputError {
        OutputError::Unwritable { target: self.target.display().to_string(), source }
    }

    fn stage_and_rename(&self, artefacts: &Artefacts) -> io::Result<()> {
        let (fresh, replaced) = (self.staging.folder("fresh")?, self.staging.folder("replaced")?);
        for (name, contents) in artefacts.iter() {
            fs::write(fresh.join(name), contents)?;
        }
        fs::create_dir_all(&self.target)?;
        self.exchange_all(artefacts, &fresh, &replaced)
    }

    /// Moves every file to its place, or after a failure every one back.
    fn exchange_all(&self, artefacts: &Artefacts, fresh: &Path, replaced: &Path) -> io::Result<()> {
        let mut moved = Vec::new();
        for (name, _) in artefacts.iter() {
            let paths = [self.target.as_path(), fresh, replaced].map(|folder| folder.join(name));
            let exchanged = exchange(&paths);
            moved.push(paths);
            if let Err(error) = exchanged {
                moved.iter().for_each(undo);
                return Err(error);
            }
        }
        Ok(())
    }
}

/// Moves the file at `place`, if any, to `old`, and the one at `new` to `place`.
fn exchange([place, new, old]: &[PathBuf; 3]) -> io::Result<()> {
    if fs::symlink_metadata(place).is_ok() {
        fs::rename(place, old)?;
    }
    fs::rename(new, place)
}

/// Takes back an exchange as far as it went. Runs after a failure that is reported already, so its own are not.
fn undo([place, new, old]: &[PathBuf; 3]) {
    if !new.exists() {
        let _ = fs::rename(place, new);
    }
    if !place.exists() && fs::symlink_metadata(old).is_ok() {
        let _ = fs::rename(old, place);
    }
}

#[cfg(test)]
mod tests;
