//! What the replicates of a study left behind, on disk: a study that was interrupted goes on where it stood, and one that asks for more
//! replicates runs those alone.
//!
//! While a study runs, `unfinished.sums` is written anew from time to time: whole, to the disk, and then renamed. The report of a study that
//! takes long keeps the same as `replicates.sums`. Neither is a result; both may be removed.

use crate::consistency::{Ended, Keeper, Origin, RunState, Snapshot, Unusable};
use miette::Diagnostic;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use switchback_io::input::own;
use switchback_io::output::{Disk, make_folder, remove};
use thiserror::Error;

/// What a report keeps.
pub const CHECKPOINT_FILE: &str = "replicates.sums";

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
pub struct Checkpoint {
    place: PathBuf,
    disk: Disk,
    origin: Origin,
    /// Whether somebody asked the study to stop.
    is_stopped: fn() -> bool,
    /// When it was written last, or else begun, and how long writing took.
    last: (Instant, Duration),
    failed: Option<CheckpointError>,
}

/// Sums could not be kept, or are not a study's.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The system refuses.
    #[error("{path}: cannot keep there what the replicates left behind: {source}")]
    #[diagnostic(help(
        "give a folder that you may write to, on a disk with space left, and run the command again: what was kept before is continued"
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
    pub run_state: RunState,
    /// What a person should know of it.
    pub reported: Option<String>,
}

impl Checkpoint {
    /// A place in the folder of a report; nothing is written yet. `is_stopped` is asked between batches.
    pub fn new(folder: &Path, origin: Origin, is_stopped: fn() -> bool) -> Self {
        let last = (Instant::now(), Duration::ZERO);
        let (place, disk) = (folder.join(UNFINISHED_FILE), Disk::while_running());
        Self { place, disk, origin, is_stopped, last, failed: None }
    }

    /// Takes up what a former run left in the folder, the further of two; `begin` is the study before its first replicate.
    ///
    /// # Errors
    /// [`CheckpointError`] if a file is there that is none of Switchback's, or cannot be read.
    pub fn take_up(&self, begin: &RunState) -> Result<Found, CheckpointError> {
        let mut found = Found { run_state: begin.clone(), reported: None };
        for name in [CHECKPOINT_FILE, UNFINISHED_FILE] {
            let place = self.place.with_file_name(name);
            let bytes = match own(&place) {
                Err(error) if is_nothing(&error) => continue,
                other => other.map_err(|source| unwritable(&place, source))?,
            };
            match begin.clone().read(&bytes, &self.origin) {
                Ok(run_state) if run_state.replicates() > found.run_state.replicates() => {
                    let reported =
                        format!("{} replicates of a former run are continued", run_state.replicates());
                    found = Found { run_state, reported: Some(reported) };
                }
                Ok(_) => {}
                Err(Unusable::Foreign) => {
                    return Err(CheckpointError::Foreign { path: place.display().to_string() });
                }
                Err(why) if found.reported.is_none() => {
                    found.reported = Some(format!("{}: {why}: begun anew", place.display()));
                }
                Err(_) => {}
            }
        }
        Ok(found)
    }

    /// Writes how far the study has come.
    ///
    /// # Errors
    /// [`CheckpointError`] if the system refuses; what was written before is still there.
    pub(crate) fn write(&mut self, snapshot: &Snapshot<'_>) -> Result<(), CheckpointError> {
        let begun = Instant::now();
        let folder = self.place.parent().map_or(Ok(()), make_folder);
        let written = folder.and_then(|()| self.disk.replace(&self.place, &snapshot.to_bytes(&self.origin)));
        self.last = (Instant::now(), begun.elapsed());
        written.map_err(|source| unwritable(&self.place, source))
    }

    /// The same after a study that was stopped, whatever stopped it.
    ///
    /// # Errors
    /// [`CheckpointError`] if something could not be kept.
    pub fn conclude(&mut self, run_state: &RunState, ended: Ended) -> Result<(), CheckpointError> {
        match self.failed.take() {
            Some(error) => Err(error),
            None if ended == Ended::Stopped => self.write(&run_state.snapshot()),
            None => Ok(()),
        }
    }

    /// Whether a report that took so many seconds of one thread keeps its sums.
    pub fn is_worth_it(&self, seconds: f64) -> bool {
        seconds > WORTH_KEEPING || self.disk.is_eager()
    }

    /// The file as a finished report keeps it.
    pub fn bytes(&self, run_state: &RunState) -> Vec<u8> {
        run_state.snapshot().to_bytes(&self.origin)
    }

    /// Removes it: the report shows all.
    ///
    /// # Errors
    /// [`CheckpointError`] if the system refuses.
    pub fn close(self) -> Result<(), CheckpointError> {
        match remove(&self.place) {
            Err(error) if !is_nothing(&error) => Err(unwritable(&self.place, error)),
            _ => Ok(()),
        }
    }
}

impl Keeper for Checkpoint {
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

fn unwritable(place: &Path, source: io::Error) -> CheckpointError {
    CheckpointError::Unwritable { path: place.display().to_string(), source }
}
