//! Renames that can be taken back.

use super::disk::Disk;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What was renamed so far.
#[derive(Debug)]
pub(super) struct Moves<'d> {
    disk: &'d Disk,
    done: Vec<[PathBuf; 2]>,
}

impl<'d> Moves<'d> {
    /// Nothing yet.
    pub(super) fn new(disk: &'d Disk) -> Self {
        Self { disk, done: Vec::new() }
    }

    /// Renames a file or folder to a name that is free.
    pub(super) fn rename(&mut self, from: PathBuf, to: PathBuf) -> io::Result<()> {
        self.disk.rename(&from, &to)?;
        self.done.push([from, to]);
        Ok(())
    }

    /// Takes all of it back, the last first. It runs after a failure that is reported already, so its own are not.
    pub(super) fn undo(self) {
        for [from, to] in self.done.iter().rev() {
            let _ = fs::rename(to, from);
        }
    }
}

/// Whether something has this name, be it a link that leads nowhere.
pub(super) fn is_there(place: &Path) -> bool {
    fs::symlink_metadata(place).is_ok()
}
