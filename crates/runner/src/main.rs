//! The `switchback` binary.

use std::hint::black_box;
use std::process::ExitCode;
use switchback::{cli, failure, interrupt};

fn main() -> ExitCode {
    keep_memory();
    interrupt::install();
    failure::exit_code(cli::run(std::env::args_os().collect()))
}

/// A diagnosis takes and leaves thousands of blocks of some ten thousand bytes. The GNU C library hands them back to the system and
/// asks for them again, at a cost of a tenth of the time, until it has seen a large block come back: from then on it keeps up to twice
/// as much. Elsewhere this does nothing.
fn keep_memory() {
    /// Of larger blocks it learns nothing.
    const LARGE: usize = 31 << 20;
    drop(black_box(Vec::<u8>::with_capacity(LARGE)));
}
