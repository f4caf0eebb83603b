//! `switchback launch SCENARIO.toml --slurm`

use crate::failure::{CommandResult, Outcome};
use crate::input::stream;
use crate::launch::Launch;
use crate::options::{Force, Quiet};
use crate::output::print;
use crate::rig::in_shell;
use clap::ArgGroup;
use miette::{Diagnostic, IntoDiagnostic};
use std::io;
use std::path::{Path, PathBuf, absolute};
use std::process::Command;
use thiserror::Error;

/// Write the script by which a scheduler runs a study or an examination in parts and merges them, and submit it if asked to.
#[derive(Debug, clap::Args)]
#[command(group(ArgGroup::new("scheduler").required(true)))]
pub struct Args {
    /// The scenario file, where every node of the cluster finds it.
    scenario: PathBuf,

    /// For Slurm: job arrays of parts, and a merge job behind them
    #[arg(long, group = "scheduler")]
    slurm: bool,

    /// In how many parts
    #[arg(long, value_name = "K", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    tasks: u32,

    /// Time limit of a part, as sbatch takes it; a part that reaches it goes on in another turn
    #[arg(long, value_name = "TIME")]
    time: Option<String>,

    /// The partition to run in
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,

    /// The report goes into this folder, the parts into DIR-parts beside it [default: reports/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Submit it instead of printing it
    #[arg(long)]
    submit: bool,

    #[command(flatten)]
    quiet: Quiet,

    #[command(flatten)]
    force: Force,
}

/// What the folder of the parts gets.
const SCRIPT: &str = "launch.sh";

/// The scheduler did not take it.
#[derive(Debug, Error, Diagnostic)]
enum SubmitError {
    #[error("{script}: cannot be run: {source}")]
    #[diagnostic(help("submit it by hand where the scheduler is: bash {script}"))]
    NotRun { script: String, source: io::Error },
    #[error("{script}: the scheduler refused it")]
    #[diagnostic(help("its words are above; change the script, and submit it by hand: bash {script}"))]
    Refused { script: String },
}

/// Prints the script, or writes and submits it.
///
/// # Errors
/// A scenario that is not there, a folder that cannot be written, a scheduler that refuses.
pub fn run(args: &Args) -> CommandResult {
    crate::input::read_text(&args.scenario)?;
    let name = stream::stem(&args.scenario).unwrap_or_else(|| "study".to_owned());
    let out = args.out.clone().unwrap_or_else(|| Path::new("reports").join(&name));
    let out = absolute(out).into_diagnostic()?;
    let mut work = out.as_os_str().to_owned();
    work.push("-parts");
    let launch = Launch {
        command: command(args),
        program: std::env::current_exe().into_diagnostic()?,
        scenario: absolute(&args.scenario).into_diagnostic()?,
        name,
        parts: args.tasks as usize,
        work: work.into(),
        out,
        options: options(args),
    };
    let script = launch.slurm();
    if !args.submit {
        print(&script)?;
        return Ok(Outcome::Done);
    }
    let place = launch.work.join(SCRIPT);
    std::fs::create_dir_all(&launch.work).into_diagnostic()?;
    args.force.claim_file(Some(&place), &[])?.into_iter().try_for_each(|file| file.commit(script.clone()))?;
    let script = in_shell(&place.display().to_string());
    let status = Command::new("bash").arg(&place).status();
    let status = status.map_err(|source| SubmitError::NotRun { script: script.clone(), source })?;
    if !status.success() {
        return Err(SubmitError::Refused { script }.into());
    }
    Ok(Outcome::Done)
}

fn options(args: &Args) -> Vec<String> {
    let time = args.time.iter().map(|time| format!("--time={time}"));
    time.chain(args.partition.iter().map(|partition| format!("--partition={partition}"))).collect()
}

/// The command, without the paths of this machine.
fn command(args: &Args) -> String {
    let mut words = vec![
        "switchback launch".to_owned(),
        in_shell(&stream::file_name(&args.scenario)),
        "--slurm".to_owned(),
    ];
    words.push(format!("--tasks {}", args.tasks));
    words.extend(args.time.iter().map(|time| format!("--time {}", in_shell(time))));
    words.extend(args.partition.iter().map(|partition| format!("--partition {}", in_shell(partition))));
    words.join(" ")
}
