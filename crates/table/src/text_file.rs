//! A whole file as text.

use super::door::read_within;
use super::file_error::FileError;
use super::text_kind::TextKind;
use std::path::Path;

/// Reads a file as UTF-8 text; a byte order mark at its start is dropped.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, cannot be read, holds more than its kind may, or is no UTF-8; a stream that is silent for 10 s.
pub fn read_text(path: &Path, kind: TextKind) -> Result<String, FileError> {
    let bytes = read_within(path, kind.most())?;
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
