//! Standard output and standard error.

use super::text::visible;
use std::io::{IsTerminal, Write};

/// Prints a page on standard output. A reader that closed its end early (`| head`) needs no more of it.
///
/// # Errors
/// If standard output cannot be written for any other reason.
pub fn print(page: &str) -> miette::Result<()> {
    match std::io::stdout().write_all(page.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(miette::miette!("cannot print the result: {error}"))
        }
        _ => Ok(()),
    }
}

/// Writes a message to standard error, made [`visible`]. The work goes on even where that terminal or pipe is closed.
pub fn note(words: &str) {
    let _is_closed = std::io::stderr().write_all(visible(words).as_bytes());
}

/// Whether a person sees what is written to standard error.
pub fn is_watched() -> bool {
    std::io::stderr().is_terminal()
}
