//! `--quiet`

use switchback_io::output::{note, print, visible};

/// Whether anything but errors is reported.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub(crate) struct Quiet {
    /// Neither progress nor words or tables, only errors and what --json asks for
    #[arg(long)]
    pub(crate) quiet: bool,
}

impl Quiet {
    /// Prints words, or keeps silent.
    ///
    /// # Errors
    /// If stdout cannot be written.
    pub(crate) fn describe(self, words: &str) -> miette::Result<()> {
        if self.quiet { Ok(()) } else { print(&visible(words)) }
    }

    /// Shows on the standard error how the work goes, or keeps silent.
    pub(crate) fn note(self, words: &str) {
        if !self.quiet {
            note(words);
        }
    }

    /// Prints the JSON that was asked for, or else shows the words.
    ///
    /// # Errors
    /// If stdout cannot be written.
    pub(crate) fn describe_or(
        self,
        is_json: bool,
        json: impl FnOnce() -> String,
        words: impl FnOnce() -> String,
    ) -> miette::Result<()> {
        match (is_json, self.quiet) {
            (true, _) => print(&json()),
            (false, true) => Ok(()),
            (false, false) => print(&visible(&words())),
        }
    }
}
