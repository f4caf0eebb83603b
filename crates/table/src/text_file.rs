//! A whole file as text.

use super::file_error::FileError;
use super::stream::{self, is_stream};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Reads a file as UTF-8 text; a byte order mark at its start is dropped.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, cannot be read, or is no UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let bytes = read_bytes(path)?;
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

/// Reads the bytes of a file, or of a stream as far as it goes within bounds.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, or cannot be read; a stream that is silent for 10 s or goes on beyond 1 GiB.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    if is_stream(path) {
        return stream::read(path);
    }
    let mut file = open(path)?;
    let mut bytes = Vec::new();
    match file.read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(source) => Err(FileError::Unreadable { path: path.display().to_string(), source }),
    }
}

/// Opens a file that is no stream.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, or cannot be opened.
pub(crate) fn open(path: &Path) -> Result<File, FileError> {
    let shown = path.display().to_string();
    if path.is_dir() {
        return Err(FileError::Directory { help: instead_of_folder(path), path: shown });
    }
    File::open(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => FileError::Missing { path: shown },
        _ => FileError::Unreadable { path: shown, source },
    })
}

/// Names the one rig file of a folder, or its files of measurements.
fn instead_of_folder(folder: &Path) -> String {
    let mut files: Vec<_> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.sort();
    let ending = |path: &Path, wanted: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(wanted));
    let manifests: Vec<_> = files.iter().filter(|path| ending(path, "toml")).collect();
    let tables: Vec<_> = files.iter().filter(|path| ending(path, "csv")).collect();
    match (&manifests[..], &tables[..]) {
        ([only], _) => format!("give the file in it: {}", only.display()),
        ([], [only]) => format!("give the file in it: {}", only.display()),
        ([], [_, _, ..]) => {
            format!("give the {} CSV files in it: {}", tables.len(), folder.join("*.csv").display())
        }
        _ => "give the path of a file in it".to_owned(),
    }
}
