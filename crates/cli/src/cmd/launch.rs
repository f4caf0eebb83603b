//! `switchback launch SCENARIO.toml --slurm` or `--hq`

use crate::failure::{CommandResult, Outcome};
use crate::launch::{Engine, Launch, TimeLimit};
use crate::options::Force;
use clap::ArgGroup;
use miette::{Diagnostic, IntoDiagnostic, miette};
use std::io;
use std::path::{Path, PathBuf, absolute};
use switchback_io::input::{program, stream};
use switchback_io::output::{in_shell, make_folder, path_in_shell, print, run_script};
use switchback_io::values::whole;
use switchback_lab::examination::{self, design_of};
use switchback_study::refuse_other_kinds;
use switchback_study::scenario::Scenario;
use thiserror::Error;

/// Write the script by which a scheduler runs a study or an examination in parts and merges them, and submit it if asked to.
#[derive(Debug, clap::Args)]
#[command(group(ArgGroup::new("scheduler").required(true)))]
pub(crate) struct Args {
    /// The scenario file, where every node of the cluster finds it.
    scenario: PathBuf,

    /// For Slurm: job arrays of parts, and a merge job behind them
    #[arg(long, group = "scheduler")]
    slurm: bool,

    /// For HyperQueue: a task array of parts; the script waits for them and merges
    #[arg(long, group = "scheduler")]
    hq: bool,

    /// In how many parts
    #[arg(long, value_name = "K", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    tasks: u32,

    /// Threads of each part
    #[arg(long, value_name = "N", default_value = "1", value_parser = whole::<usize>(1..=1024))]
    cpus: usize,

    /// Time limit of a part, as sbatch takes it: 90 (minutes), 1:30:00, 2-0 (days); a part that reaches it goes on in another turn
    #[arg(long, value_name = "TIME")]
    time: Option<TimeLimit>,

    /// Slurm's partition to run in
    #[arg(long, value_name = "NAME", conflicts_with = "hq")]
    partition: Option<String>,

    /// The report goes into this folder, the parts into DIR-parts beside it [default: reports/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Submit it instead of printing it
    #[arg(long)]
    submit: bool,

    #[command(flatten)]
    force: Force,
}

/// What the folder of the parts gets.
const SCRIPT: &str = "launch.sh";

/// The script did not get through.
#[derive(Debug, Error, Diagnostic)]
enum SubmitError {
    #[error("{script}: cannot be run: {source}")]
    #[diagnostic(help("submit it by hand where the scheduler is: bash {script}"))]
    NotRun { script: String, source: io::Error },
    #[error("{script}: did not get through")]
    #[diagnostic(help("the reason stands above; once it is mended, continue with: bash {script}"))]
    Failed { script: String },
}

/// Slurm signals a part one to two minutes before its time limit.
const LEAST_OF_SLURM: u64 = 180;

/// Prints the script, or writes and submits it.
///
/// # Errors
/// A scenario that cannot be run, a folder that cannot be written, a scheduler that refuses.
pub(crate) fn run(args: &Args) -> CommandResult {
    check(args)?;
    let launch = launch(args)?;
    let script = launch.script();
    if !args.submit {
        print(&script)?;
        return Ok(Outcome::Done);
    }
    let place = launch.work.join(SCRIPT);
    make_folder(&launch.work).into_diagnostic()?;
    args.force.claim_file(Some(&place), &[])?.into_iter().try_for_each(|file| file.commit(script.clone()))?;
    let script = path_in_shell(&place);
    let status = run_script(&place);
    let status = status.map_err(|source| SubmitError::NotRun { script: script.clone(), source })?;
    match status.code() {
        Some(0) => Ok(Outcome::Done),
        // The script of HyperQueue ends with what its merge says.
        Some(1) if launch.engine == Engine::HyperQueue && launch.out.join("results.json").exists() => {
            Ok(Outcome::Unmet)
        }
        _ => Err(SubmitError::Failed { script }.into()),
    }
}

/// What every part would refuse is refused once, before anything is submitted.
fn check(args: &Args) -> miette::Result<()> {
    let file = &args.scenario;
    refuse_other_kinds(file)?;
    let design = design_of(file);
    match design {
        Some(_) => drop(examination::read(file)?),
        None => drop(Scenario::read(file)?),
    }
    if let Some(time) = args.time.as_ref().filter(|time| args.slurm && time.seconds() < LEAST_OF_SLURM) {
        return Err(miette!(
            "--time {time}: Slurm signals a part up to two minutes early; give 3 minutes at least"
        ));
    }
    Ok(())
}

fn name(args: &Args) -> String {
    stream::stem(&args.scenario).unwrap_or_else(|| "study".to_owned())
}

fn launch(args: &Args) -> miette::Result<Launch> {
    let name = name(args);
    let out = args.out.clone().unwrap_or_else(|| Path::new("reports").join(&name));
    let out = absolute(out).into_diagnostic()?;
    let mut work = out.as_os_str().to_owned();
    work.push("-parts");
    Ok(Launch {
        engine: if args.hq { Engine::HyperQueue } else { Engine::Slurm },
        command: command(args),
        program: program().into_diagnostic()?,
        scenario: absolute(&args.scenario).into_diagnostic()?,
        name,
        parts: args.tasks as usize,
        threads: args.cpus,
        time: args.time.clone(),
        options: args.partition.iter().map(|partition| format!("--partition={partition}")).collect(),
        work: work.into(),
        out,
    })
}

/// The command, without the paths of this machine.
fn command(args: &Args) -> String {
    let engine = if args.hq { "--hq" } else { "--slurm" };
    let mut words = vec![
        "switchback launch".to_owned(),
        in_shell(&stream::file_name(&args.scenario)),
        engine.to_owned(),
        format!("--tasks {}", args.tasks),
    ];
    words.extend((args.cpus > 1).then(|| format!("--cpus {}", args.cpus)));
    words.extend(args.time.iter().map(|time| format!("--time {time}")));
    words.extend(args.partition.iter().map(|partition| format!("--partition {}", in_shell(partition))));
    words.join(" ")
}
