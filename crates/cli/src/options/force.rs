//! `--force`

use std::path::Path;
use switchback_io::output::{FileError, FolderError, OutputFile, OutputFolder};

/// Whether files that someone else wrote may be replaced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::Args)]
pub(crate) struct Force {
    /// Replace files even if something else wrote or changed them
    #[arg(long)]
    pub(crate) force: bool,
}

impl Force {
    /// Claims a folder, `names` being files that will be written there, a `*` standing for any part of one.
    ///
    /// # Errors
    /// [`FolderError`] if the folder cannot be written, or one of those files is someone else's, unless forced.
    pub(crate) fn claim(self, folder: &Path, names: &[&str]) -> Result<OutputFolder, FolderError> {
        OutputFolder::claim(folder, self.force)?.expecting(names)
    }

    /// Claims a file by its path, where one was asked for. `inputs` are the files that the command reads: they are never replaced.
    ///
    /// # Errors
    /// [`FileError`] if something is there, unless forced, or the file cannot be written.
    pub(crate) fn claim_file(
        self,
        path: Option<&Path>,
        inputs: &[&Path],
    ) -> Result<Option<OutputFile>, FileError> {
        path.map(|path| OutputFile::claim(path, self.force, inputs)).transpose()
    }

    /// The same as [`claim`](Self::claim) where a folder need not be asked for; none of the `inputs` is replaced.
    ///
    /// # Errors
    /// As [`claim`](Self::claim).
    pub(crate) fn claim_if_asked(
        self,
        folder: Option<&Path>,
        names: &[&str],
        inputs: &[&Path],
    ) -> Result<Option<OutputFolder>, FolderError> {
        let claim = |folder| self.claim(folder, names)?.sparing(inputs.iter().copied());
        folder.map(claim).transpose()
    }
}
