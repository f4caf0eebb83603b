//! `--threads`

use switchback_io::threads::{self, ThreadsError};
use switchback_io::values::whole;

/// How many threads work.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub(crate) struct Threads {
    /// Worker threads [default: one a core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = whole::<u16>(1..=threads::Threads::MOST.into()))]
    threads: Option<u16>,
}

impl Threads {
    /// The same for a library.
    pub(crate) fn get(self) -> threads::Threads {
        threads::Threads(self.threads)
    }

    /// How many work at the same time: as many as are asked for, but no more than there are cores.
    pub(crate) fn at_once(self) -> usize {
        self.get().at_once()
    }

    /// Works on a thread pool of that size.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub(crate) fn install<R: Send>(self, work: impl FnOnce() -> R + Send) -> Result<R, ThreadsError> {
        self.get().install(work)
    }
}
