//! `--yes`

use super::{Quiet, Threads};
use switchback_study::estimate::{TooLong, permit};

/// Whether what takes days is run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub(crate) struct Yes {
    /// Run it even if it is estimated to take longer than a day
    #[arg(long)]
    yes: bool,
}

impl Yes {
    /// Lets work go on that takes so many seconds of one thread, unless that is more than a day on those at hand; where it is and is allowed,
    /// the estimate is reported on stderr.
    ///
    /// # Errors
    /// [`TooLong`] with the estimate.
    pub(crate) fn permit(self, seconds: f64, threads: Threads, quiet: Quiet) -> Result<(), TooLong> {
        if let Some(estimate) = permit(seconds, threads.get(), self.yes)? {
            quiet.note(&format!("this takes about {estimate}\n"));
        }
        Ok(())
    }
}
