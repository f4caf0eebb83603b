//! Renames that can be undone.

use super::disk::{self, Disk};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The renames so far.
#[derive(Debug)]
pub(super) struct Moves<'d> {
    disk: &'d Disk,
    done: Vec<(Undo, PathBuf, PathBuf)>,
}

/// The call that undoes a move, given its two paths.
type Undo = fn(&Path, &Path) -> io::Result<()>;

impl<'d> Moves<'d> {
    /// None yet.
    pub(super) fn new(disk: &'d Disk) -> Self {
        Self { disk, done: Vec::new() }
    }

    /// Renames a file or folder to a name that is free.
    pub(super) fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        self.disk.rename(from, to)?;
        self.done.push((|from, to| fs::rename(to, from), from.to_owned(), to.to_owned()));
        Ok(())
    }

    /// Exchanges two folders, see [`Disk::exchange`].
    pub(super) fn exchange(&mut self, one: &Path, other: &Path) -> io::Result<bool> {
        let is_done = self.disk.exchange(one, other)?;
        if is_done {
            self.done.push((
                |one, other| disk::exchange(one, other).map(drop),
                one.to_owned(),
                other.to_owned(),
            ));
        }
        Ok(is_done)
    }

    /// Undoes all of them, the last first. It follows a failure that is reported already, so its own failures are not.
    pub(super) fn undo(self) {
        for (undo, from, to) in self.done.iter().rev() {
            let _ = undo(from, to);
        }
    }
}
