//! `switchback init DATA.csv … [--out rig.toml]`

use super::data_args::DataArgs;
use crate::failure::{CommandResult, Outcome};
use crate::output::{Artefacts, OutputFolder, print};
use crate::rig;
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Write the rig file that `gap` and `identify` would use for these files, with comments, to be changed at will.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    data: DataArgs,

    /// Write it here instead of printing it.
    #[arg(long, value_name = "RIG.toml")]
    out: Option<PathBuf>,

    /// Replace the file that is there.
    #[arg(long, requires = "out")]
    force: bool,
}

/// Why no rig file was written.
#[derive(Debug, Error, Diagnostic)]
pub enum InitError {
    /// A file is there already.
    #[error("{path}: exists already and is left as it is")]
    #[diagnostic(help("give another name, or `--force` to replace it"))]
    Exists {
        /// The file.
        path: String,
    },
    /// The path cannot name a file.
    #[error("{path}: is no name for a rig file")]
    #[diagnostic(help("give a file, for instance `--out rig.toml`"))]
    NoFile {
        /// The path as given.
        path: String,
    },
}

/// Reads the files as `gap` would, prints or writes the rig file that says so.
///
/// # Errors
/// Files that cannot be read, or a rig file that is there already.
pub fn run(args: &Args) -> CommandResult {
    let target = args.out.as_deref().map(|path| Target::of(path, args.force)).transpose()?;
    let loaded = args.data.load("init", false)?;
    let Some(target) = target else {
        print(&rig::manifest(&loaded, None))?;
        return Ok(Outcome::Done);
    };
    let mut artefacts = Artefacts::default();
    artefacts.add(target.name.as_str(), rig::manifest(&loaded, Some(target.folder)));
    OutputFolder::claim(target.folder)?.commit(&artefacts)?;
    Ok(Outcome::Done)
}

struct Target<'a> {
    folder: &'a Path,
    name: String,
}

impl<'a> Target<'a> {
    fn of(path: &'a Path, force: bool) -> Result<Self, InitError> {
        let shown = || path.display().to_string();
        if path.is_dir() {
            return Err(InitError::NoFile { path: shown() });
        }
        if path.exists() && !force {
            return Err(InitError::Exists { path: shown() });
        }
        let name = path.file_name().ok_or_else(|| InitError::NoFile { path: shown() })?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Ok(Self { folder, name: name.to_string_lossy().into_owned() })
    }
}
