//! The `switchback` binary.

use std::process::ExitCode;
use switchback::{cli, failure, interrupt};
use switchback_io::platform;

fn main() -> ExitCode {
    platform::keep_memory();
    interrupt::install();
    failure::exit_code(cli::run(std::env::args_os().collect()))
}
