//! Why there is no page.

use miette::Diagnostic;
use std::io;
use std::path::PathBuf;
use switchback_io::input::FileError;
use switchback_io::input::json_file::JsonError;
use switchback_io::model::ModelError;
use switchback_io::output::NotWhole;
use switchback_study::results::ResultsError;
use thiserror::Error;

/// Why a page cannot be drawn from a folder.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum PageError {
    /// There is no such folder.
    #[error("{}: there is no such folder", folder.display())]
    #[diagnostic(help("{HOLDS_A_REPORT}"))]
    Missing {
        /// The folder asked for.
        folder: PathBuf,
    },
    /// It is a file.
    #[error("{}: this is a file, but the folder of a report is wanted", path.display())]
    #[diagnostic(help("name the folder that it lies in"))]
    IsFile {
        /// The path asked for.
        path: PathBuf,
    },
    /// Something in it cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    #[diagnostic(help("make it readable, or run the command that wrote the report again"))]
    Unreadable {
        /// The path tried.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A file in it cannot be read as text.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// There is no report in it.
    #[error("{}: there is no report in this folder", folder.display())]
    #[diagnostic(help("{HOLDS_A_REPORT}"))]
    NoReport {
        /// The folder asked for.
        folder: PathBuf,
    },
    /// There is more than one report in it.
    #[error("{}: holds {kinds}: which of them is the report is ambiguous", folder.display())]
    #[diagnostic(help("write each report into a folder of its own with `--out`"))]
    Mixture {
        /// The folder asked for.
        folder: PathBuf,
        /// The reports in it.
        kinds: String,
    },
    /// Its files were not written together.
    #[error("{}: {one} is of {of}, but {other} of {but}", folder.display())]
    #[diagnostic(help("run the command that writes this report again: its files belong together"))]
    Unrelated {
        /// The folder asked for.
        folder: PathBuf,
        /// A file.
        one: String,
        /// Its rig.
        of: String,
        /// Another.
        other: String,
        /// The rig of that.
        but: String,
    },
    /// A file that the page needs is not there.
    #[error("{}: {file} is missing", folder.display())]
    #[diagnostic(help("run the command that writes this report again"))]
    Lacks {
        /// The folder asked for.
        folder: PathBuf,
        /// The file's name.
        file: &'static str,
    },
    /// A file is of another version.
    #[error("{}: has the format {found}, but this program reads `{wanted}`", file.display())]
    #[diagnostic(help(
        "run the command that writes this report again, or draw the page with the version that wrote it"
    ))]
    OtherFormat {
        /// The file.
        file: PathBuf,
        /// Its format.
        found: String,
        /// The format that is read.
        wanted: &'static str,
    },
    /// The content of a file is wrong.
    #[error("{place}: {message}")]
    #[diagnostic(help("run the command that writes this report again"))]
    Content {
        /// The file, with line and column where these are known.
        place: String,
        /// The fault.
        message: String,
    },
    /// A figure is none.
    #[error("{file}: is no drawing of this program: {why}")]
    #[diagnostic(help(
        "run the command that writes this report again: a page holds only drawings of the program"
    ))]
    NoDrawing {
        /// The file.
        file: String,
        /// The first thing in it that no drawing holds.
        why: String,
    },
    /// A model cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Model(#[from] ModelError),
    /// The folder is not as one run wrote it.
    #[error(transparent)]
    #[diagnostic(transparent)]
    NotWhole(#[from] NotWhole),
    /// The results of a study cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Results(#[from] ResultsError),
}

const HOLDS_A_REPORT: &str =
    "name a folder that `switchback SCENARIO.toml`, `gap --out` or `identify --out` wrote";

impl From<JsonError> for PageError {
    fn from(JsonError { place, message, .. }: JsonError) -> Self {
        Self::Content { place, message }
    }
}
