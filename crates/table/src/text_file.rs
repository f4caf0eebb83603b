//! A whole file as text.

use super::door::read_within;
use super::file_error::FileError;
use std::path::Path;

/// Most bytes of a text: a study of a thousand cells has a few million.
const LONGEST: u64 = 1 << 30;

/// Reads a file as UTF-8 text; a byte order mark at its start is dropped.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, cannot be read, holds more than 1 GiB, or is no UTF-8; a stream that is silent for 10 s.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let bytes = read_within(path, LONGEST)?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok(match text.strip_prefix('\u{feff}') {
            Some(rest) => rest.to_owned(),
            None => text,
        }),
        Err(error) => {
            let valid = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..valid].iter().filter(|byte| **byte == b'\n').count();
            Err(FileError::NotUtf8 { path: path.display().to_string(), line })
        }
    }
}
