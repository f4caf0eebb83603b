//! Why nothing was written.

use miette::Diagnostic;
use std::io;
use thiserror::Error;

/// Why results could not be written.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum OutputError {
    /// A file stands where a folder is wanted.
    #[error("{target}: cannot be an output folder: {obstacle} is a file")]
    #[diagnostic(help("give the path of a folder, existing or new"))]
    NotAFolder {
        /// The folder as given.
        target: String,
        /// The part of its path that is a file.
        obstacle: String,
    },
    /// A folder stands where a result file is to go.
    #[error("{target}: cannot write the file {name} there: a folder has that name")]
    #[diagnostic(help("move that folder away or give another output folder"))]
    FileIsFolder {
        /// The folder as given.
        target: String,
        /// The artefact's name.
        name: String,
    },
    /// A file stands where the folder of a file is wanted.
    #[error("{target}: cannot be written: {obstacle} is a file, not a folder")]
    #[diagnostic(help("give the path of a file in a folder, existing or new"))]
    NoFolder {
        /// The file as given.
        target: String,
        /// The part of its path that is no folder.
        obstacle: String,
    },
    /// A folder stands where a file is wanted.
    #[error("{target}: is a folder, not a file")]
    #[diagnostic(help("give the name of a file, in this folder or elsewhere"))]
    IsFolder {
        /// The file as given.
        target: String,
    },
    /// A file stands already where one is to be written.
    #[error("{target}: is there already")]
    #[diagnostic(help("give another name, or --force to replace it"))]
    Exists {
        /// The file as given.
        target: String,
    },
    /// What the command reads would be replaced.
    #[error("{target}: is read by this command, so it cannot be written by it too")]
    #[diagnostic(help("give another name: what was measured is never replaced, with --force or without"))]
    IsInput {
        /// The file as given.
        target: String,
    },
    /// A file that someone else wrote or changed would be replaced.
    #[error("{target}: {files} would be lost there")]
    #[diagnostic(help("give another folder, or --force to replace what is there"))]
    Foreign {
        /// The folder as given.
        target: String,
        /// The files with what makes them someone else's.
        files: String,
    },
    /// Another run writes to the same place.
    #[error("{target}: {holder} is writing there")]
    #[diagnostic(help("wait until it has ended, or give another place"))]
    Busy {
        /// The folder or file as given.
        target: String,
        /// The process.
        holder: String,
    },
    /// The system refused to write a file.
    #[error("{target}: cannot write this file: {source}")]
    #[diagnostic(help("give a file in a folder that you may write to, on a disk with space left"))]
    FileUnwritable {
        /// The file as given.
        target: String,
        /// What the system said.
        source: io::Error,
    },
    /// The system refused to write.
    #[error("{target}: cannot write to this output folder: {source}")]
    #[diagnostic(help("give a folder that you may write to, on a disk with space left"))]
    Unwritable {
        /// The folder as given.
        target: String,
        /// What the system said.
        source: io::Error,
    },
}
