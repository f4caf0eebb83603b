//! The door for bytes that come in: every file that the program reads is opened here, and every stream in [`stream`].
//!
//! | opened by | what is accepted | bound |
//! |---|---|---|
//! | [`read_within`], [`read_text`](crate::read_text) | files, and streams: pipes, devices, the standard input | bytes, by [kind](crate::TextKind); of a stream also 10 s of silence, and 256 MiB |
//! | [`open`] | files that are read piece by piece | none: no piece is kept |
//! | [`regular`] | files that are read here and there, as archives | left to the reader |
//! | [`own`] | files that the program wrote, as lists of hashes and sums | 4 GiB |
//! | [`names`] | folders | a million names |

use crate::file_error::FileError;
use crate::stream::{self, is_stream};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Most bytes of a file that is kept in memory whole.
pub const LARGEST: u64 = 4 << 30;

/// Most names of a folder.
const MOST_NAMES: usize = 1_000_000;

/// The bytes of a file, or of a stream as far as it goes within bounds.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, holds more than `most` bytes, or cannot be read; a stream that is silent for 10 s, goes on
/// beyond that or 256 MiB, or is no text where it should be.
pub fn read_within(path: &Path, most: u64) -> Result<Vec<u8>, FileError> {
    if is_stream(path) {
        return stream::read(path, most);
    }
    let file = open(path)?;
    let unreadable = |source| FileError::Unreadable { path: path.display().to_string(), source };
    limited(file, most)
        .map_err(unreadable)?
        .ok_or_else(|| FileError::TooLong { path: path.display().to_string(), most })
}

/// A file that was opened here.
pub(crate) type Opened = File;

/// Opens a file that is no stream.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, or cannot be opened.
pub(crate) fn open(path: &Path) -> Result<Opened, FileError> {
    let shown = || path.display().to_string();
    if path.is_dir() {
        return Err(FileError::Directory { help: instead_of_folder(path), path: shown() });
    }
    match opened(path) {
        Ok(Some(file)) => Ok(file),
        Ok(None) => Err(FileError::NoFile { path: shown() }),
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            Err(FileError::Missing { path: shown() })
        }
        Err(source) => Err(FileError::Unreadable { path: shown(), source }),
    }
}

/// Opens a file on a disk, to be read here and there.
///
/// # Errors
/// If there is none, or it is a folder, a pipe or a device.
pub fn regular(path: &Path) -> io::Result<File> {
    opened(path)?.ok_or_else(|| {
        let what = if path.is_dir() { "is a folder" } else { "is a pipe or a device" };
        io::Error::new(io::ErrorKind::InvalidInput, format!("{what}, not a file"))
    })
}

/// The bytes of a file that this program wrote.
///
/// # Errors
/// If there is none, it is a folder, a pipe or a device, or holds more than 4 GiB.
pub fn own(path: &Path) -> io::Result<Vec<u8>> {
    limited(regular(path)?, LARGEST)?.ok_or_else(|| io::Error::from(io::ErrorKind::FileTooLarge))
}

/// Where this program is.
///
/// # Errors
/// If the system does not say.
pub fn program() -> io::Result<PathBuf> {
    std::env::current_exe()
}

/// Names in a folder that are text, in the order of the alphabet.
///
/// # Errors
/// If it cannot be read, or holds more than a million.
pub fn names(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)?.take(MOST_NAMES) {
        names.extend(entry?.file_name().into_string());
    }
    if names.len() == MOST_NAMES {
        return Err(io::Error::other("the folder holds more than a million files"));
    }
    names.sort();
    Ok(names)
}

/// Opens a file; none where it is something else. Looked at once it is open, so that nothing can take its place in between; and opened so that
/// a pipe without a writer is not waited for.
fn opened(path: &Path) -> io::Result<Option<File>> {
    let mut how = OpenOptions::new();
    how.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        how.custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    }
    let file = how.open(path)?;
    let is_file = file.metadata()?.is_file();
    Ok(is_file.then_some(file))
}

/// All bytes of a file; none where there are more than `most`.
fn limited(file: File, most: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    if file.metadata()?.len() <= most {
        file.take(most + 1).read_to_end(&mut bytes)?;
        return Ok((bytes.len() as u64 <= most).then_some(bytes));
    }
    Ok(None)
}

/// Names the one rig file of a folder, or its files of measurements.
fn instead_of_folder(folder: &Path) -> String {
    let files: Vec<_> = names(folder).unwrap_or_default().into_iter().map(|name| folder.join(name)).collect();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_within_its_bound() {
        let root = tempfile::tempdir().expect("a temporary folder");
        let place = root.path().join("a");
        fs::write(&place, "four").expect("it can be written");
        assert_eq!(read_within(&place, 4).expect("four bytes"), b"four");
        assert!(matches!(read_within(&place, 3), Err(FileError::TooLong { most: 3, .. })));
        assert!(matches!(read_within(&root.path().join("b"), 3), Err(FileError::Missing { .. })));
        assert!(matches!(read_within(root.path(), 3), Err(FileError::Directory { .. })));
        // A file of many bytes, none of which is on the disk.
        File::create(&place).and_then(|file| file.set_len(1 << 42)).expect("a sparse file");
        assert!(own(&place).is_err() && read_within(&place, LARGEST).is_err());
        assert_eq!(names(root.path()).expect("a folder"), ["a"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_no_file_of_the_programs_own() {
        for place in ["/dev/zero", "/", "/dev/null"] {
            assert!(own(Path::new(place)).is_err() && regular(Path::new(place)).is_err(), "{place}");
        }
        assert!(matches!(open(Path::new("/dev/zero")), Err(FileError::NoFile { .. })));
    }
}
