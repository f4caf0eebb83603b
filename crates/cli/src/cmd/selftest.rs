//! `switchback selftest`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Quiet, Threads};
use switchback_io::output::note;
use switchback_io::values::whole;
use switchback_lab::selftest::{CHECKS, Finding, json, table};

/// Check in a minute that the program computes on this machine what it should; exit code 1 where it does not.
///
/// Noise, both engines, known answers, coverage, Monte-Carlo errors, a planted effect: a row each, with what was found and what must be.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Of all noise that is drawn; the checks pass on every seed but one in a hundred thousand.
    #[arg(long, default_value_t = 1, value_parser = whole::<u32>(0..=u64::from(u32::MAX)))]
    seed: u32,

    /// Print one JSON object with every figure instead of the table.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    quiet: Quiet,
}

/// Runs every check, shows what was found.
///
/// # Errors
/// If the system gives no threads, or stdout cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let seed = u64::from(args.seed);
    let one = |(k, check): (usize, &switchback_lab::selftest::Check)| {
        if !args.quiet.quiet {
            note(&format!("{} of {}: {}\n", k + 1, CHECKS.len(), check.name));
        }
        check.run(seed)
    };
    let findings: Vec<Finding> = args.threads.install(|| CHECKS.iter().enumerate().map(one).collect())?;
    args.quiet.describe_or(args.json, || json(&findings, seed), || table(&findings, seed))?;
    Ok(if findings.iter().all(Finding::holds) { Outcome::Done } else { Outcome::Unmet })
}
