//! The command line.
//!
//! A verb is one file in [`crate::cmd`] with its `Args` and `run`; to add one, add its variant to [`Verb`] and its arm to
//! [`Verb::run`].

use crate::cmd;
use crate::failure::CommandResult;
use clap::{Parser, Subcommand};

/// Identify switched-hysteresis systems, benchmark their estimators' consistency, diagnose the sim-to-real gap.
///
/// Exit codes: 0 done; 1 an expectation or comparison failed; 2 bad input, nothing written.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Identify(cmd::identify::Args),
    Rig(cmd::rig::Args),
}

impl Cli {
    /// Runs what was asked for.
    ///
    /// # Errors
    /// The report of an input that could not be used.
    pub fn run(self) -> CommandResult {
        match self.verb {
            Verb::Identify(args) => cmd::identify::run(&args),
            Verb::Rig(args) => cmd::rig::run(&args),
        }
    }
}
