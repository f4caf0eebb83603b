//! The folder that a command's files go to.

use super::artefacts::Artefacts;
use super::disk::Disk;
use super::hash_list::{HashList, Owner};
use super::lock::LockError;
use super::replacement::{finish, replace, unfinished};
use super::staging::{READY, Staging, obstacle, uninterrupted};
use crate::input::own;
use miette::Diagnostic;
use serde_json::Value;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A folder that has been found writable, to be filled in one step.
///
/// [`claim`](Self::claim) comes before the computation, so that a wrong path costs no time and no other run writes to the same folder
/// meanwhile; [`commit`](Self::commit) after it. Files are first written whole to a staging folder on the same disk, which then takes
/// the folder's place. A claim that is dropped leaves nothing behind; a commit that fails leaves the folder as it was, a signal waits
/// until it is done, and after a kill the next claim finishes a replacement that was begun.
///
/// Only files that the program wrote itself are replaced. It knows them by a hidden list beside them, `.switchback.sha256`, of names
/// and SHA-256: a file that is not listed there was written by someone else, and one whose hash differs was changed by someone else.
/// Both are refused unless the folder is forced, at once where the names are known ([`expecting`](Self::expecting)), else on commit.
/// `sha256sum -c .switchback.sha256` checks a folder by the same list.
///
/// Of the names expected, the program's own unchanged files that are not written anew are removed: they are those of a former run.
/// Files that the command reads ([`sparing`](Self::sparing)) are never replaced, not even by force.
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    staging: Staging,
    disk: Disk,
    forced: bool,
    /// Names that the command may write, a `*` standing for any part of one.
    expected: Vec<String>,
    /// Files that the command reads, without links.
    inputs: Vec<PathBuf>,
}

/// The label of a part of a study or examination.
pub const PART: &str = "part.json";

/// Why a folder cannot be written. The first value is the folder as given.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum FolderError {
    /// The second value, a part of its path, is a file.
    #[error("{0}: cannot be an output folder: {1} is a file")]
    #[diagnostic(help("give the path of a folder, existing or new"))]
    NotAFolder(String, String),
    /// The second value, a file of the command, is a folder there.
    #[error("{0}: cannot write the file {1} there: a folder has that name")]
    #[diagnostic(help("move that folder away or give another output folder"))]
    FileIsFolder(String, String),
    /// A file in it, the only value, is read by the command.
    #[error("{0}: is read by this command, so it cannot be written by it too")]
    #[diagnostic(help("give another name: what was measured is never replaced, with --force or without"))]
    IsInput(String),
    /// The second value, files that someone else wrote or changed, would be replaced.
    #[error("{0}: {1} would be lost there")]
    #[diagnostic(help("give another folder, or --force to replace what is there"))]
    Foreign(String, String),
    /// It holds a part of a study or examination, which this command does not write.
    #[error("{0}: holds a part of a study, part.json, which would be lost there")]
    #[diagnostic(help("give another folder, or --force to replace the part"))]
    Part(String),
    /// The second value, a process, writes there.
    #[error("{0}: {1} is writing there")]
    #[diagnostic(help("wait until it has ended, or give another place"))]
    Busy(String, String),
    /// The system refuses.
    #[error("{0}: cannot write to this output folder: {1}")]
    #[diagnostic(help("give a folder that you may write to, on a disk with space left"))]
    Unwritable(String, #[source] io::Error),
}

impl OutputFolder {
    /// Makes sure that the folder can be written, and that no other run writes there. If `forced`, files that someone else wrote or
    /// changed may be replaced.
    ///
    /// # Errors
    /// [`FolderError`] if part of the path is a file, another run writes to the folder, or the system refuses.
    pub fn claim(target: &Path, forced: bool) -> Result<Self, FolderError> {
        Self::claim_on(Disk::default(), target, forced)
    }

    fn claim_on(disk: Disk, target: &Path, forced: bool) -> Result<Self, FolderError> {
        let shown = target.display().to_string();
        if let Some(obstacle) = obstacle(target) {
            return Err(FolderError::NotAFolder(shown, obstacle.display().to_string()));
        }
        let staging = Staging::claim(target).map_err(|error| match error {
            LockError::Busy(process) => FolderError::Busy(shown, process),
            LockError::Refused(source) => FolderError::Unwritable(shown, source),
        })?;
        let (target, expected, inputs) = (target.to_owned(), Vec::new(), Vec::new());
        let folder = Self { target, staging, disk, forced, expected, inputs };
        folder.finish()?;
        Ok(folder)
    }

    /// Makes sure that files of these names can be written, as far as names are known before the computation: a `*` stands for any part
    /// of one.
    ///
    /// # Errors
    /// [`FolderError`] if a file of such a name is someone else's, or a folder has the name.
    pub fn expecting(self, names: &[&str]) -> Result<Self, FolderError> {
        let folder = self.clearing(names);
        folder.refuse_foreign(&folder.expected_names(), "")?;
        if !names.contains(&PART) {
            folder.refuse_part(None)?;
        }
        Ok(folder)
    }

    /// Adds names of files of a former run that are removed, beside those [expected](Self::expecting).
    pub fn clearing(mut self, names: &[&str]) -> Self {
        self.expected.extend(names.iter().map(|name| (*name).to_owned()));
        self
    }

    /// Makes sure that no file is replaced that the command reads.
    ///
    /// # Errors
    /// [`FolderError`] if one of these has an [expected](Self::expecting) name in this folder.
    pub fn sparing<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, FolderError> {
        let inputs = inputs.into_iter().filter_map(|input| fs::canonicalize(input).ok()).collect();
        let folder = Self { inputs, ..self };
        folder.refuse_inputs(&folder.expected_names())?;
        Ok(folder)
    }

    /// The folder, as it was given.
    pub fn path(&self) -> &Path {
        &self.target
    }

    /// Writes all artefacts. The program's own files of the same names are replaced, those of a former run removed, others left alone.
    ///
    /// # Errors
    /// [`FolderError`] if a file of such a name is someone else's, or the system refuses; the folder is then as it was before.
    pub fn commit(self, artefacts: &Artefacts) -> Result<(), FolderError> {
        let _until_done = uninterrupted();
        let names: Vec<String> = artefacts.iter().map(|(name, _)| name.to_owned()).collect();
        self.refuse_inputs(&names)?;
        self.refuse_part(artefacts.bytes(PART))?;
        let list = self.refuse_foreign(&names, "")?;
        let is_stale = |name: &String| {
            !names.contains(name) && matches!(list.owner(&self.target, name), Ok(Owner::Program))
        };
        let stale: Vec<String> = self.expected_names().into_iter().filter(is_stale).collect();
        let list = list.after(artefacts, &stale);
        self.write(artefacts, &list).map_err(|source| self.unwritable(source))
    }

    fn write(&self, artefacts: &Artefacts, list: &HashList) -> io::Result<()> {
        let (staging, disk) = (self.staging.folder(), &self.disk);
        let fresh = staging.join("fresh");
        fs::create_dir(&fresh)?;
        for (name, text) in list.files() {
            disk.write(&fresh.join(name), text.as_bytes())?;
        }
        for (name, contents) in artefacts.iter() {
            disk.write(&fresh.join(name), contents)?;
        }
        disk.sync_folder(&fresh)?;
        fs::rename(fresh, staging.join(READY))?;
        replace(staging, self.staging.place(), disk)
    }

    /// Finishes the replacement that a killed run began. That run had made sure that nobody else's files would be lost; those that were
    /// changed since are replaced only by force.
    fn finish(&self) -> Result<(), FolderError> {
        let _until_done = uninterrupted();
        let names = unfinished(self.staging.folder()).map_err(|source| self.unwritable(source))?;
        self.refuse_foreign(&names, "a run was killed while it replaced this folder; ")?;
        finish(self.staging.folder(), self.staging.place(), &self.disk)
            .map_err(|source| self.unwritable(source))?;
        self.staging.clear();
        Ok(())
    }

    /// Names of the files in the folder that are expected.
    fn expected_names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.target).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| fits(name, &self.expected)).collect();
        names.sort_unstable();
        names
    }

    fn refuse_inputs(&self, names: &[String]) -> Result<(), FolderError> {
        let is_input =
            |place: &PathBuf| fs::canonicalize(place).is_ok_and(|place| self.inputs.contains(&place));
        match names.iter().map(|name| self.target.join(name)).find(is_input) {
            Some(place) => Err(FolderError::IsInput(place.display().to_string())),
            None => Ok(()),
        }
    }

    /// Makes sure that no part is lost that took hours to run, unless the folder is forced: one that is there is replaced by the same part only.
    ///
    /// # Errors
    /// [`FolderError::Part`] if there is one of another scenario, or another of it, than `label` says.
    pub fn refuse_part(&self, label: Option<&[u8]>) -> Result<(), FolderError> {
        let own_part = label.and_then(part_of);
        let is_lost = |there: Vec<u8>| part_of(&there).is_some_and(|there| own_part != Some(there));
        if !self.forced && own(&self.target.join(PART)).is_ok_and(is_lost) {
            return Err(FolderError::Part(self.target.display().to_string()));
        }
        Ok(())
    }

    /// The list of the program's own files, if every file of these names is one of them or may be replaced by force.
    fn refuse_foreign(&self, names: &[String], reason: &str) -> Result<HashList, FolderError> {
        let shown = || self.target.display().to_string();
        let list = HashList::in_folder(&self.target).map_err(|source| self.unwritable(source))?;
        let mut foreign = Vec::new();
        for name in names {
            if self.target.join(name).is_dir() {
                return Err(FolderError::FileIsFolder(shown(), name.clone()));
            }
            match list.owner(&self.target, name).map_err(|source| self.unwritable(source))? {
                Owner::Program => {}
                Owner::Editor => foreign.push(format!("{name} (changed since it was written)")),
                Owner::Stranger => foreign.push(format!("{name} (not written by this program)")),
            }
        }
        if foreign.is_empty() || self.forced {
            return Ok(list);
        }
        Err(FolderError::Foreign(shown(), reason.to_owned() + &foreign.join(", ")))
    }

    fn unwritable(&self, source: io::Error) -> FolderError {
        FolderError::Unwritable(self.target.display().to_string(), source)
    }
}

/// Which part of which scenario a label names; none where it is no label.
fn part_of(label: &[u8]) -> Option<(String, Value)> {
    let label: Value = serde_json::from_slice(label).ok()?;
    Some((label.get("scenario")?.as_str()?.to_owned(), label.get("shard")?.clone()))
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
