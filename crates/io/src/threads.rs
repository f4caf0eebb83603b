//! How many threads work.

use miette::Diagnostic;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use std::thread::available_parallelism;
use thiserror::Error;

/// How many threads work; results do not depend on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Threads(
    /// One a core where none is given.
    pub Option<u16>,
);

/// The system gives no threads.
#[derive(Debug, Error, Diagnostic)]
#[error(transparent)]
pub struct ThreadsError(#[from] ThreadPoolBuildError);

impl Threads {
    /// More threads than any machine that this is run on has cores: each takes a stack and a list of work, and systems refuse tens of thousands.
    pub const MOST: u16 = 1024;

    /// How many work at the same time: as many as are asked for, but no more than there are cores.
    pub fn at_once(self) -> usize {
        let cores = available_parallelism().map_or(1, usize::from);
        self.0.map_or(cores, |threads| cores.min(threads.into()))
    }

    /// Works on a thread pool of that size.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn install<R: Send>(self, work: impl FnOnce() -> R + Send) -> Result<R, ThreadsError> {
        let threads = self.0.map_or(0, usize::from);
        Ok(ThreadPoolBuilder::new().num_threads(threads).build()?.install(work))
    }
}
