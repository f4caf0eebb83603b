//! The folder that artefacts go to.

use super::disk::Disk;
use super::moves::is_there;
use super::replace::{READY, Replacement};
use super::staging::{Staging, Uninterrupted, Unstaged, nearest};
use super::written::{Owner, Written};
use super::{Artefacts, OutputError};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A folder that has been found writable, to be filled in one go.
///
/// [`claim`](Self::claim) comes before the computation, so that a wrong path costs no time and no other run writes to the same folder
/// meanwhile; [`commit`](Self::commit) after it. Files are first written whole to a staging folder on the same disk, which then takes
/// the folder's place. A claim that is dropped leaves nothing behind; a commit that fails leaves the folder as it was, a signal waits
/// until it is done, and of a process that is killed the next claim finishes what it began.
///
/// Only files that the program wrote itself are replaced. It knows them by a hidden list beside them, `.switchback.sha256`, of names
/// and SHA-256: a file that is not listed there was written by someone else, and one whose hash differs was changed by
/// someone else. Both are refused unless the folder is forced, at once where the names are known
/// ([`expecting`](Self::expecting)), else on commit. `sha256sum -c .switchback.sha256` checks a folder by the same list.
///
/// Of the names expected, the program's own unchanged files that are not written anew are removed: they are those of a former run.
/// What the command was given to read ([`sparing`](Self::sparing)) is never replaced, not even by force.
#[derive(Debug)]
pub struct OutputFolder {
    /// As it was given.
    target: PathBuf,
    /// The same without links.
    place: PathBuf,
    staging: Staging,
    disk: Disk,
    forced: bool,
    /// Names that the command may write, a `*` standing for any part of one.
    expected: Vec<String>,
    /// Files that the command reads, without links.
    inputs: Vec<PathBuf>,
}

impl OutputFolder {
    /// Makes sure that the folder can be written, and that no other run writes there: a staging folder is made beside it. If `forced`,
    /// files that someone else wrote or changed may be replaced.
    ///
    /// # Errors
    /// [`OutputError`] if part of the path is a file, another run holds the folder, or the system refuses.
    pub fn claim(target: &Path, forced: bool) -> Result<Self, OutputError> {
        Self::claim_on(Disk::default(), target, forced)
    }

    fn claim_on(disk: Disk, target: &Path, forced: bool) -> Result<Self, OutputError> {
        let shown = target.display().to_string();
        let nearest = if is_there(target) { target } else { nearest(target) };
        if !nearest.is_dir() {
            return Err(OutputError::NotAFolder { target: shown, obstacle: nearest.display().to_string() });
        }
        let (place, staging) = Staging::claim(target, (&disk, forced)).map_err(|why| match why {
            Unstaged::Busy(holder) => OutputError::Busy { target: shown, holder },
            Unstaged::Refused(source) => OutputError::Unwritable { target: shown, source },
            Unstaged::Unfinished(error) => error,
        })?;
        let (target, expected, inputs) = (target.to_owned(), Vec::new(), Vec::new());
        Ok(Self { target, place, staging, disk, forced, expected, inputs })
    }

    /// Makes sure that files of these names can be written, as far as names are known before the computation: a `*` stands for
    /// any part of one.
    ///
    /// # Errors
    /// [`OutputError`] if a file of such a name is someone else's, or a folder has the name.
    pub fn expecting(self, names: &[&str]) -> Result<Self, OutputError> {
        let folder = self.clearing(names);
        let there = folder.there_already();
        folder.refuse_what_is_not_ours(there.iter().map(String::as_str))?;
        Ok(folder)
    }

    /// Names of which files of a former run are removed, beside those [expected](Self::expecting).
    pub fn clearing(mut self, names: &[&str]) -> Self {
        self.expected.extend(names.iter().map(|name| (*name).to_owned()));
        self
    }

    /// Makes sure that no file is replaced that the command reads.
    ///
    /// # Errors
    /// [`OutputError`] if one of these has an [expected](Self::expecting) name in this folder.
    pub fn sparing<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        let inputs = inputs.into_iter().filter_map(|input| fs::canonicalize(input).ok()).collect();
        let folder = Self { inputs, ..self };
        let there = folder.there_already();
        folder.refuse_inputs(there.iter().map(String::as_str))?;
        Ok(folder)
    }

    /// Files in the folder of the names expected.
    fn there_already(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.target).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| fits(name, &self.expected)).collect();
        names.sort_unstable();
        names
    }

    /// The folder, as it was given.
    pub fn path(&self) -> &Path {
        &self.target
    }

    /// Writes all artefacts. The program's own files of the same names are replaced, those of a former run removed, others left alone.
    ///
    /// # Errors
    /// [`OutputError`] if a file of such a name is someone else's, or the system refuses; the folder then holds what it held before.
    pub fn commit(self, artefacts: &Artefacts) -> Result<(), OutputError> {
        let _until_done = Uninterrupted::new();
        self.refuse_inputs(artefacts.iter().map(|(name, _)| name))?;
        let written = self.refuse_what_is_not_ours(artefacts.iter().map(|(name, _)| name))?;
        let stale = self.stale(&written, artefacts);
        let lists = written.without(&stale).with(artefacts);
        self.stage_and_replace((artefacts, &lists), &stale).map_err(|source| self.unwritable(source))
    }

    /// The program's own unchanged files of the names expected that are not written anew.
    fn stale(&self, written: &Written, artefacts: &Artefacts) -> Vec<String> {
        let is_stale = |name: &String| {
            artefacts.iter().all(|(new, _)| new != name)
                && matches!(written.owner(&self.target, name), Ok(Owner::Program))
        };
        self.there_already().into_iter().filter(is_stale).collect()
    }

    fn refuse_inputs<'a>(&self, names: impl IntoIterator<Item = &'a str>) -> Result<(), OutputError> {
        for name in names {
            let place = self.target.join(name);
            if fs::canonicalize(&place).is_ok_and(|place| self.inputs.contains(&place)) {
                return Err(OutputError::IsInput { target: place.display().to_string() });
            }
        }
        Ok(())
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

    fn stage_and_replace(
        &self,
        (artefacts, lists): (&Artefacts, &Written),
        stale: &[String],
    ) -> io::Result<()> {
        let fresh = self.staging.folder("fresh")?;
        for (name, list) in lists.files() {
            self.disk.write(&fresh.join(name), list.as_bytes())?;
        }
        for (name, contents) in artefacts.iter() {
            self.disk.write(&fresh.join(name), contents)?;
        }
        self.disk.sync_folder(&fresh)?;
        fs::rename(fresh, self.staging.path().join(READY))?;
        let Self { place, disk, staging, .. } = self;
        Replacement { staging: staging.path(), target: place, stale, disk }.run()
    }
}

/// Whether a name is one of these, where a `*` stands for any part of it.
fn fits(name: &str, expected: &[String]) -> bool {
    expected.iter().any(|expected| match expected.split_once('*') {
        None => name == expected,
        Some((before, after)) => {
            name.strip_prefix(before).is_some_and(|rest| rest.len() >= after.len() && rest.ends_with(after))
        }
    })
}

#[cfg(test)]
mod tests;
