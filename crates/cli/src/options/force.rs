//! `--force`

use std::path::Path;
use switchback_io::output::{OutputError, OutputFile, OutputFolder};

/// Whether files that someone else wrote may be replaced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub struct Force {
    /// Replace files even if something else wrote or changed them
    #[arg(long)]
    pub force: bool,
}

impl Force {
    /// Claims a folder, `names` being files that will be written there, a `*` standing for what is not known of one yet.
    ///
    /// # Errors
    /// [`OutputError`] if the folder cannot be written, or one of those files is someone else's and not given up.
    pub fn claim(self, folder: &Path, names: &[&str]) -> Result<OutputFolder, OutputError> {
        OutputFolder::claim(folder, self.force)?.expecting(names)
    }

    /// Claims a file by its path, where one was asked for. `inputs` are what the command reads: they are never replaced.
    ///
    /// # Errors
    /// [`OutputError`] if something is there and not given up, or the file cannot be written.
    pub fn claim_file(
        self,
        path: Option<&Path>,
        inputs: &[&Path],
    ) -> Result<Option<OutputFile>, OutputError> {
        path.map(|path| OutputFile::claim(path, self.force, inputs)).transpose()
    }

    /// The same as [`claim`](Self::claim) where a folder need not be asked for; none of the `inputs` is replaced.
    ///
    /// # Errors
    /// As [`claim`](Self::claim).
    pub fn claim_if_asked(
        self,
        folder: Option<&Path>,
        names: &[&str],
        inputs: &[&Path],
    ) -> Result<Option<OutputFolder>, OutputError> {
        let claim = |folder| self.claim(folder, names)?.sparing(inputs.iter().copied());
        folder.map(claim).transpose()
    }
}
