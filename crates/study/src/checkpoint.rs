//! What the replicates of a study left behind, on disk: a study that was interrupted goes on where it stood, and one that asks for more
//! replicates runs those alone.
//!
//! While a study runs, `unfinished.sums` is written anew from time to time: whole, to the disk, and then renamed. The report of a study that
//! takes long keeps the same as `replicates.sums`. Neither is a result; both may be removed.

use crate::consistency::{Ended, Keeper, Origin, Snapshot, Standing, Unusable};
use miette::Diagnostic;
use std::fs;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use switchback_io::output::Disk;
use thiserror::Error;

/// What a report keeps.
pub const KEPT_FILE: &str = "replicates.sums";

/// The same while the study runs.
pub(crate) const UNFINISHED_FILE: &str = "unfinished.sums";

/// Keeping takes at most this share of the time.
const SHARE: u32 = 20;

/// Less time than this is not worth keeping.
const LEAST: Duration = Duration::from_secs(1);

/// Seconds of one thread from which on a study's sums are kept with its report, so that more replicates can be added.
const WORTH_KEEPING: f64 = 30.0;

/// Keeps a study in its folder while it runs.
#[derive(Debug)]
pub struct Kept {
    place: PathBuf,
    disk: Disk,
    origin: Origin,
    /// Whether somebody asked the study to stop.
    is_stopped: fn() -> bool,
    /// When it was written last, or else begun, and how long writing took.
    last: (Instant, Duration),
    failed: Option<KeptError>,
}

/// Sums could not be kept, or are not a study's.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum KeptError {
    /// The system refuses.
    #[error("{path}: cannot keep there what the replicates left behind: {source}")]
    #[diagnostic(help(
        "give a folder that you may write to, on a disk with space left, and run the command again: what was kept before is gone on with"
    ))]
    Unwritable {
        /// The file.
        path: String,
        /// What the system says.
        source: io::Error,
    },
    /// A file of that name holds something else.
    #[error("{path}: holds something else than sums that Switchback kept")]
    #[diagnostic(help("move it away, or write the report into another folder"))]
    Foreign {
        /// The file.
        path: String,
    },
}

/// What was found of a former run.
#[derive(Debug)]
pub struct Found {
    /// Where the study goes on: where it stood, or before the first replicate.
    pub standing: Standing,
    /// What a person should know of it.
    pub told: Option<String>,
}

impl Kept {
    /// A place in the folder of a report; nothing is written yet. `is_stopped` is asked between batches.
    pub fn new(folder: &Path, origin: Origin, is_stopped: fn() -> bool) -> Self {
        let last = (Instant::now(), Duration::ZERO);
        let (place, disk) = (folder.join(UNFINISHED_FILE), Disk::while_running());
        Self { place, disk, origin, is_stopped, last, failed: None }
    }

    /// Takes up what a former run left in the folder, the further of two; `begin` is the study before its first replicate.
    ///
    /// # Errors
    /// [`KeptError`] if a file is there that is none of Switchback's, or cannot be read.
    pub fn take_up(&self, begin: &Standing) -> Result<Found, KeptError> {
        let mut found = Found { standing: begin.clone(), told: None };
        for name in [KEPT_FILE, UNFINISHED_FILE] {
            let place = self.place.with_file_name(name);
            let bytes = match fs::read(&place) {
                Err(error) if is_nothing(&error) => continue,
                other => other.map_err(|source| unwritable(&place, source))?,
            };
            match begin.clone().read(&bytes, &self.origin) {
                Ok(standing) if standing.replicates() > found.standing.replicates() => {
                    let told =
                        format!("{} replicates of a former run are gone on with", standing.replicates());
                    found = Found { standing, told: Some(told) };
                }
                Ok(_) => {}
                Err(Unusable::Foreign) => {
                    return Err(KeptError::Foreign { path: place.display().to_string() });
                }
                Err(why) if found.told.is_none() => {
                    found.told = Some(format!("{}: {why}: begun anew", place.display()));
                }
                Err(_) => {}
            }
        }
        Ok(found)
    }

    /// Writes how far the study has come.
    ///
    /// # Errors
    /// [`KeptError`] if the system refuses; what was written before is still there.
    pub(crate) fn write(&mut self, snapshot: &Snapshot<'_>) -> Result<(), KeptError> {
        let begun = Instant::now();
        let folder = self.place.parent().map_or(Ok(()), fs::create_dir_all);
        let written = folder.and_then(|()| self.disk.replace(&self.place, &snapshot.to_bytes(&self.origin)));
        self.last = (Instant::now(), begun.elapsed());
        written.map_err(|source| unwritable(&self.place, source))
    }

    /// The same after a study that was stopped, whatever stopped it.
    ///
    /// # Errors
    /// [`KeptError`] if something could not be kept.
    pub fn conclude(&mut self, standing: &Standing, ended: Ended) -> Result<(), KeptError> {
        match self.failed.take() {
            Some(error) => Err(error),
            None if ended == Ended::Stopped => self.write(&standing.snapshot()),
            None => Ok(()),
        }
    }

    /// Whether a report that took so many seconds of one thread keeps its sums.
    pub fn is_worth_it(&self, seconds: f64) -> bool {
        seconds > WORTH_KEEPING || self.disk.is_eager()
    }

    /// The file as a finished report keeps it.
    pub fn bytes(&self, standing: &Standing) -> Vec<u8> {
        standing.snapshot().to_bytes(&self.origin)
    }

    /// Removes it: the report tells all.
    ///
    /// # Errors
    /// [`KeptError`] if the system refuses.
    pub fn close(self) -> Result<(), KeptError> {
        match fs::remove_file(&self.place) {
            Err(error) if !is_nothing(&error) => Err(unwritable(&self.place, error)),
            _ => Ok(()),
        }
    }
}

impl Keeper for Kept {
    fn keep(&mut self, snapshot: &Snapshot<'_>) -> ControlFlow<()> {
        let (when, took) = self.last;
        if when.elapsed() < LEAST.max(took * SHARE) && !self.disk.is_eager() {
            return ControlFlow::Continue(());
        }
        match self.write(snapshot) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.failed = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    fn is_stopped(&self) -> bool {
        (self.is_stopped)()
    }
}

fn is_nothing(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory)
}

fn unwritable(place: &Path, source: io::Error) -> KeptError {
    KeptError::Unwritable { path: place.display().to_string(), source }
}
