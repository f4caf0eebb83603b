//! Pages on stdout.

use super::visible;
use std::io::Write;

/// Prints a page. A reader that closed its end early (`| head`) has what it wanted.
///
/// # Errors
/// If stdout cannot be written for any other reason.
pub fn print(page: &str) -> miette::Result<()> {
    match std::io::stdout().write_all(page.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(miette::miette!("cannot print the result: {error}"))
        }
        _ => Ok(()),
    }
}

/// Tells something on stderr, made [`visible`]. Where nobody listens any more, a terminal that was closed or a pipe, the work goes on all the same.
pub fn note(words: &str) {
    let _nobody_listens = std::io::stderr().write_all(visible(words).as_bytes());
}
