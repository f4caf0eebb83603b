//! The calls that change the disk, each of which may fail: they are in one file so that tests can make each of them fail.

use super::faults::Faults;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// The disk.
#[derive(Debug)]
pub struct Disk {
    faults: Faults,
}

impl Default for Disk {
    fn default() -> Self {
        Self::with(Faults::of("SWITCHBACK_FAULTS"))
    }
}

impl Disk {
    /// A disk with faults.
    pub(super) fn with(faults: Faults) -> Self {
        Self { faults }
    }

    /// The disk for the sums that a study keeps while it runs: its faults differ from those of the report.
    pub fn while_running() -> Self {
        Self::with(Faults::of("SWITCHBACK_FAULTS_WHILE_RUNNING"))
    }

    /// Whether sums that are kept from time to time are kept at every opportunity.
    pub fn is_eager(&self) -> bool {
        self.faults.eager
    }

    /// Writes a file in place of another, which stays until the new one is whole.
    ///
    /// # Errors
    /// If the system refuses; the other is still there.
    pub fn replace(&self, place: &Path, contents: &[u8]) -> io::Result<()> {
        let mut name = place.as_os_str().to_owned();
        name.push(".new");
        let new = Path::new(&name);
        let _of_a_killed_run = fs::remove_file(new);
        let written = self.write(new, contents).and_then(|()| self.rename(new, place));
        if written.is_err() {
            let _ = fs::remove_file(new);
        }
        written
    }

    /// Writes a new file. When it returns, the contents will survive a loss of power.
    pub(super) fn write(&self, place: &Path, contents: &[u8]) -> io::Result<()> {
        self.faults.before_call()?;
        let mut file = File::create_new(place)?;
        file.write_all(contents)?;
        self.faults.before_call()?;
        file.sync_all()
    }

    /// Makes the names in a folder survive a loss of power, where the file system can.
    pub(super) fn sync_folder(&self, folder: &Path) -> io::Result<()> {
        self.faults.before_call()?;
        if !cfg!(unix) {
            // Elsewhere a folder cannot be opened as a file is.
            return Ok(());
        }
        let synced = File::open(folder)?.sync_all();
        let cannot = |error: &io::Error| {
            matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported)
        };
        if synced.as_ref().is_err_and(cannot) { Ok(()) } else { synced }
    }

    /// Renames a file or folder; a file that is there already is replaced.
    pub(super) fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.faults.before_call()?;
        fs::rename(from, to)
    }

    /// Gives a file a second name.
    pub(super) fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.faults.before_call()?;
        fs::hard_link(from, to)
    }

    /// Exchanges two folders in one step; `Ok(false)`, and nothing is changed, where the system or this file system cannot.
    pub(super) fn exchange(&self, one: &Path, other: &Path) -> io::Result<bool> {
        self.faults.before_call()?;
        if self.faults.no_exchange { Ok(false) } else { exchange(one, other) }
    }
}

/// `renameat2` with `RENAME_EXCHANGE`; on macOS `renameatx_np` with `RENAME_SWAP`.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
pub(super) fn exchange(one: &Path, other: &Path) -> io::Result<bool> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;

    // Old kernels and network file systems; overlays and other devices; mount points; folders of someone else under a sticky one.
    const IMPOSSIBLE: [Errno; 7] =
        [Errno::INVAL, Errno::NOSYS, Errno::OPNOTSUPP, Errno::XDEV, Errno::BUSY, Errno::PERM, Errno::ACCESS];
    match renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE) {
        Ok(()) => Ok(true),
        Err(error) if IMPOSSIBLE.contains(&error) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

/// Other systems have no such step.
#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
pub(super) fn exchange(_one: &Path, _other: &Path) -> io::Result<bool> {
    Ok(false)
}

/// Whether something has this name, be it a link that leads nowhere.
pub(super) fn is_there(place: &Path) -> bool {
    fs::symlink_metadata(place).is_ok()
}
