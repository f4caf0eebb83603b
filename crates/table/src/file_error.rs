//! Why a file gives no text.

use miette::Diagnostic;
use std::io;
use thiserror::Error;

/// Why a file could not be read as text.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum FileError {
    /// Nothing exists at the path.
    #[error("{path}: no such file")]
    #[diagnostic(help("check the path; it is taken relative to the folder that the command runs in"))]
    Missing {
        /// The path as given.
        path: String,
    },
    /// The path leads to a folder.
    #[error("{path}: is a folder, not a file")]
    #[diagnostic(help("{help}"))]
    Directory {
        /// The path as given.
        path: String,
        /// What to give instead.
        help: String,
    },
    /// The bytes are not UTF-8.
    #[error("{path}:{line}: the text is not UTF-8")]
    #[diagnostic(help("save the file as UTF-8 text; spreadsheets call it \"CSV UTF-8\""))]
    NotUtf8 {
        /// The path as given.
        path: String,
        /// Line of the first byte that is no UTF-8, from 1.
        line: usize,
    },
    /// Nothing came from a stream for long.
    #[error("{path}: nothing came for {seconds} s")]
    #[diagnostic(help(
        "a pipe or terminal gives bytes only while something writes into it: start its writer first, or give a file"
    ))]
    Silent {
        /// The path as given.
        path: String,
        /// How long that was.
        seconds: u64,
    },
    /// A stream goes on for too long.
    #[error("{path}: goes on beyond {mebibytes} MiB, the most that is read of such a stream")]
    #[diagnostic(help("give a file, or a stream that ends: a device as /dev/zero never does"))]
    Endless {
        /// The path as given.
        path: String,
        /// The limit.
        mebibytes: u64,
    },
    /// A stream is no text, and nothing else that is read.
    #[error("{path}: byte {byte} is zero, as in no text")]
    #[diagnostic(help("give a file, or a stream that is text: a device as /dev/zero is none"))]
    Zero {
        /// The path as given.
        path: String,
        /// The first such byte, from 1.
        byte: usize,
    },
    /// It holds more than is read.
    #[error("{path}: more than {most} bytes of it would be in memory at once")]
    #[diagnostic(help(
        "give the file that was meant: a table has lines, and this program writes nothing as large"
    ))]
    TooLong {
        /// The path as given.
        path: String,
        /// The limit.
        most: u64,
    },
    /// It is a pipe or a device where a file is wanted.
    #[error("{path}: is a pipe or a device, not a file")]
    #[diagnostic(help("give the path of a file on a disk"))]
    NoFile {
        /// The path as given.
        path: String,
    },
    /// The system refused to read it.
    #[error("{path}: cannot be read: {source}")]
    #[diagnostic(help("check that the file may be read and that its disk is present"))]
    Unreadable {
        /// The path as given.
        path: String,
        /// What the system said.
        source: io::Error,
    },
}
