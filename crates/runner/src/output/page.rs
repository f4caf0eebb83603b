//! Pages on stdout.

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
