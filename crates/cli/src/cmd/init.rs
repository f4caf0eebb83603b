//! `switchback init DATA.csv … [--out rig.toml]`

use super::data_args::DataArgs;
use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use std::path::{Path, PathBuf};
use switchback_io::output::print;
use switchback_io::rig;

/// Write the rig file that `gap` and `identify` would use for these files, with comments, to be changed at will.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    data: DataArgs,

    /// Write it here instead of printing it.
    #[arg(long, value_name = "RIG.toml")]
    out: Option<PathBuf>,

    #[command(flatten)]
    output: Output,
}

/// Reads the files as `gap` would, prints or writes the rig file that says so.
///
/// # Errors
/// Files that cannot be read, or a rig file that is there already.
pub(crate) fn run(args: &Args) -> CommandResult {
    let target = args.out.as_deref();
    let (data, survey) = args.data.survey("init", args.output.quiet)?;
    let file = args.output.force.claim_file(target, &data.inputs(&survey.plan))?;
    let manifest = rig::manifest(&survey.plan, target.map(folder));
    match file {
        Some(file) => file.commit(manifest)?,
        None => print(&manifest)?,
    }
    Ok(Outcome::Done)
}

/// The folder that a file lies in.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
