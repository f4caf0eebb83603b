//! The other end: a process that reads lines and answers by lines.

use std::fs::File;
use std::io::{self, BufRead, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Answers each line of standard input by a line of standard output, until there are no more.
///
/// # Errors
/// What `answer` refuses, or the system.
pub fn serve(mut answer: impl FnMut(&str) -> io::Result<String>) -> io::Result<()> {
    let mut output = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        let answer = answer(&line?)? + "\n";
        output.write_all(answer.as_bytes())?;
        output.flush()?;
    }
    Ok(())
}

/// So many little-endian float64 numbers of a file, from the `at`-th on.
///
/// # Errors
/// If the file ends before, or the system refuses.
pub fn numbers(file: &Path, at: usize, count: usize) -> io::Result<Vec<f64>> {
    let mut file = File::open(file)?;
    file.seek(SeekFrom::Start(8 * at as u64))?;
    let mut bytes = Vec::new();
    file.take(8 * count as u64).read_to_end(&mut bytes)?;
    let (numbers, rest) = bytes.as_chunks::<8>();
    if numbers.len() != count || !rest.is_empty() {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(numbers.iter().map(|number| f64::from_le_bytes(*number)).collect())
}
