//! The command line.
//!
//! A verb is one file in [`crate::cmd`] with its `Args` and `run`; to add one, add its variant to [`Verb`] and its arm to
//! [`Cli::run`].

use crate::cmd;
use crate::failure::CommandResult;
use clap::{Parser, Subcommand};

/// Identify switched-hysteresis systems, benchmark their estimators' consistency, diagnose the sim-to-real gap.
///
/// Exit codes: 0 done; 1 an expectation or comparison failed; 2 bad input, nothing written.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
pub struct Cli {
    #[command(subcommand)]
    verb: Option<Verb>,

    #[command(flatten)]
    study: Option<cmd::study::Args>,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Compare(cmd::compare::Args),
    Gap(cmd::gap::Args),
    Identify(cmd::identify::Args),
    Rig(cmd::rig::Args),
    Simulate(cmd::simulate::Args),
}

impl Cli {
    /// Runs what was asked for.
    ///
    /// # Errors
    /// The report of an input that could not be used.
    pub fn run(self) -> CommandResult {
        match (self.verb, self.study) {
            (Some(Verb::Compare(args)), _) => cmd::compare::run(&args),
            (Some(Verb::Gap(args)), _) => cmd::gap::run(&args),
            (Some(Verb::Identify(args)), _) => cmd::identify::run(&args),
            (Some(Verb::Rig(args)), _) => cmd::rig::run(&args),
            (Some(Verb::Simulate(args)), _) => cmd::simulate::run(&args),
            (None, Some(args)) => cmd::study::run(&args),
            (None, None) => {
                Err(miette::miette!("nothing to do; name a scenario file, or see `switchback --help`"))
            }
        }
    }
}
