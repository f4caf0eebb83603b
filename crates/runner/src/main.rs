//! The `switchback` binary.

use clap::Parser;
use std::process::ExitCode;
use switchback::{cli::Cli, failure};

fn main() -> ExitCode {
    failure::exit_code(Cli::parse().run())
}
