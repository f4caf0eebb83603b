//! `switchback init DATA.csv … [--out rig.toml]`

use super::data_args::DataArgs;
use crate::failure::{CommandResult, Outcome};
use crate::options::{Force, Quiet};
use crate::output::{Artefacts, print};
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

    #[command(flatten)]
    force: Force,

    #[command(flatten)]
    quiet: Quiet,
}

/// The path cannot name a rig file.
#[derive(Debug, Error, Diagnostic)]
#[error("{path}: is no name for a rig file")]
#[diagnostic(help("give a file, for instance `--out rig.toml`"))]
pub struct NoFileName {
    /// The path as given.
    path: String,
}

/// Reads the files as `gap` would, prints or writes the rig file that says so.
///
/// # Errors
/// Files that cannot be read, or a rig file that is there already and was written or changed by someone else.
pub fn run(args: &Args) -> CommandResult {
    let Some(path) = &args.out else {
        print(&rig::manifest(&args.data.load("init", args.quiet)?, None))?;
        return Ok(Outcome::Done);
    };
    let (folder, name) = parts(path)?;
    let claim = args.force.claim(folder, &[&name])?;
    let loaded = args.data.load("init", args.quiet)?;
    let mut artefacts = Artefacts::default();
    artefacts.add(name.as_str(), rig::manifest(&loaded, Some(folder)));
    claim.commit(&artefacts)?;
    Ok(Outcome::Done)
}

/// The folder and the file name of a path.
fn parts(path: &Path) -> Result<(&Path, String), NoFileName> {
    let unnamed = || NoFileName { path: path.display().to_string() };
    if path.is_dir() {
        return Err(unnamed());
    }
    let name = path.file_name().ok_or_else(unnamed)?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Ok((folder, name.to_string_lossy().into_owned()))
}
