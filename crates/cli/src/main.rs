//! The `switchback` program: the command line.

mod build;
mod cli;
mod cmd;
mod failure;
mod interrupt;
mod launch;
mod options;
mod progress;

use std::process::ExitCode;
use switchback_io::platform;

fn main() -> ExitCode {
    platform::keep_memory();
    interrupt::install();
    failure::exit_code(cli::run(std::env::args_os().collect()))
}
