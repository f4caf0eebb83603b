//! `--threads`

use super::whole;
use miette::IntoDiagnostic;

/// More threads than any machine that this is run on has cores: each takes a stack and a list of work, and systems refuse tens of thousands.
const MOST: u64 = 1024;

/// How many threads work.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct Threads {
    /// Worker threads [default: one a core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = whole::<u16>(1..=MOST))]
    pub threads: Option<u16>,
}

impl Threads {
    /// How many work at the same time: as many as are asked for, but no more than there are cores.
    pub fn at_once(self) -> usize {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.map_or(cores, |threads| cores.min(threads.into()))
    }

    /// Works on a thread pool of that size.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn install<R: Send>(self, work: impl FnOnce() -> R + Send) -> miette::Result<R> {
        let threads = self.threads.map_or(0, usize::from);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().into_diagnostic()?;
        Ok(pool.install(work))
    }
}
