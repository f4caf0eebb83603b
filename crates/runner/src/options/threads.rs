//! `--threads`

use super::whole;
use miette::IntoDiagnostic;

/// How many threads work.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct Threads {
    /// Worker threads [default: one a core]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = whole::<u16>(1..=65_535))]
    pub threads: Option<u16>,
}

impl Threads {
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
