//! Files that a command keeps while it runs, outside of any folder that is replaced whole.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, ExitStatus};

/// Makes a folder, and those around it, where they are not there.
///
/// # Errors
/// If the system refuses.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)
}

/// Removes a file, or a folder with nothing in it.
///
/// # Errors
/// If there is none, or the system refuses.
pub fn remove(place: &Path) -> io::Result<()> {
    if place.is_dir() { fs::remove_dir(place) } else { fs::remove_file(place) }
}

/// Writes a file in place of another, which is lost at once; the new one survives a loss of power.
///
/// # Errors
/// If the system refuses.
pub fn overwrite(place: &Path, contents: &[u8]) -> io::Result<()> {
    let mut file = File::create(place)?;
    file.write_all(contents)?;
    file.sync_all()
}

/// Runs a script of bash that this program wrote, and waits for its end.
///
/// # Errors
/// If there is no bash, or the system refuses it.
pub fn run_script(script: &Path) -> io::Result<ExitStatus> {
    Command::new("bash").arg(script).status()
}

/// A file that grows.
#[derive(Debug)]
pub struct Growing(File);

impl Growing {
    /// The file with what is in it; an empty one where there is none.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn open(place: &Path) -> io::Result<Self> {
        OpenOptions::new().create(true).append(true).open(place).map(Self)
    }

    /// Writes behind what is there.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn append(&mut self, contents: &[u8]) -> io::Result<()> {
        self.0.write_all(contents)
    }

    /// Makes what was written survive a loss of power.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn sync(&self) -> io::Result<()> {
        self.0.sync_all()
    }
}
