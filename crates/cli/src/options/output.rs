//! `--quiet` and `--force`

use super::{Force, Quiet};

/// The options of a verb that shows words and writes files.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct Output {
    /// Whether anything but errors is reported.
    #[command(flatten)]
    pub(crate) quiet: Quiet,

    /// Whether files that someone else wrote may be replaced.
    #[command(flatten)]
    pub(crate) force: Force,
}
