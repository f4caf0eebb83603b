//! Compressed texts: `.gz`.

use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;
use miette::Diagnostic;
use std::ffi::OsStr;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use switchback_table::door::read_within;
use switchback_table::{FileError, TextKind};
use thiserror::Error;

/// The most bytes that a compressed text may hold. Results of a study have a few million.
const LIMIT: u64 = TextKind::Results.most();

/// Why a compressed file gives no text. The first value is the file.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum GzipError {
    /// It cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Unreadable(#[from] FileError),
    /// It ends too early or its bytes were changed; the second value is the number of bytes of text before.
    #[error("{}: is cut off or damaged: its text cannot be read beyond byte {}", .0.display(), .1)]
    #[diagnostic(help("copy the file again from where it was taken, or run the command that wrote it"))]
    Damaged(PathBuf, usize),
    /// Its text is longer than is read.
    #[error("{}: holds more than {} bytes of text, the most that is read from a compressed file", .0.display(), .1)]
    #[diagnostic(help("this is no table of results; decompress it with gzip and look at it"))]
    TooLong(PathBuf, u64),
    /// What it holds is no text.
    #[error("{}: holds no UTF-8 text: byte {} of its content belongs to no character", .0.display(), .1)]
    #[diagnostic(help("give a file that this program wrote"))]
    NotText(PathBuf, usize),
}

/// Whether the name of a file says that it is compressed.
pub fn is_gzip(path: &Path) -> bool {
    path.extension() == Some(OsStr::new("gz"))
}

/// The text of a compressed file.
///
/// # Errors
/// [`GzipError`] if it cannot be read, is damaged, or holds more than [results](TextKind::Results) may, or no text.
pub fn read(path: &Path) -> Result<String, GzipError> {
    inflated(path, read_within(path, LIMIT)?.as_slice(), LIMIT)
}

/// The text that some bytes hold, up to a limit; `path` is what messages call them.
fn inflated(path: &Path, compressed: impl Read, limit: u64) -> Result<String, GzipError> {
    let mut bytes = Vec::new();
    let inflating = MultiGzDecoder::new(compressed).take(limit + 1).read_to_end(&mut bytes);
    inflating.map_err(|_| GzipError::Damaged(path.to_owned(), bytes.len()))?;
    if bytes.len() as u64 > limit {
        return Err(GzipError::TooLong(path.to_owned(), limit));
    }
    String::from_utf8(bytes)
        .map_err(|error| GzipError::NotText(path.to_owned(), error.utf8_error().valid_up_to()))
}

/// The compressed bytes of a text: the same for the same text, as no time and no name is among them.
pub fn compressed(text: &str) -> Vec<u8> {
    const TO_MEMORY: &str = "writing to memory";
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(text.as_bytes()).expect(TO_MEMORY);
    encoder.finish().expect(TO_MEMORY)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text_of(bytes: &[u8], limit: u64) -> Result<String, GzipError> {
        inflated(Path::new("a.gz"), bytes, limit)
    }

    #[test]
    fn a_text_comes_back() {
        for text in ["", "results", &"ten bytes ".repeat(100_000)] {
            assert_eq!(text_of(&compressed(text), LIMIT).expect("a text"), text);
        }
    }

    #[test]
    fn a_file_that_is_cut_off_or_changed_is_refused_with_its_place() {
        let whole = compressed(&(0..20_000).map(|k| format!("{k} ")).collect::<String>());
        for length in [0, 5, 12, whole.len() / 2, whole.len() - 1] {
            let error = text_of(&whole[..length], LIMIT).expect_err("cut off");
            assert!(error.to_string().starts_with("a.gz: is cut off or damaged"), "{length}: {error}");
        }
        for place in [0, whole.len() / 2, whole.len() - 5] {
            let mut changed = whole.clone();
            changed[place] ^= 0x55;
            assert!(matches!(text_of(&changed, LIMIT), Err(GzipError::Damaged(..))), "{place}");
        }
        let behind = [&whole[..], b"more"].concat();
        assert!(matches!(text_of(&behind, LIMIT), Err(GzipError::Damaged(..))));
    }

    #[test]
    fn a_small_file_of_a_long_text_is_read_up_to_the_limit() {
        let bomb = compressed(&"0".repeat(1 << 20));
        assert!(bomb.len() < 1 << 12);
        assert_eq!(text_of(&bomb, 1 << 20).expect("as long as allowed").len(), 1 << 20);
        let error = text_of(&bomb, (1 << 20) - 1).expect_err("too long");
        assert!(error.to_string().contains("more than 1048575 bytes"), "{error}");
    }

    #[test]
    fn bytes_that_are_no_text_and_a_missing_file_are_distinguished() {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(b"ab\xff").expect("memory");
        let error = text_of(&encoder.finish().expect("memory"), LIMIT);
        assert!(matches!(error, Err(GzipError::NotText(_, 2))), "{error:?}");
        assert!(matches!(read(Path::new("nowhere.gz")), Err(GzipError::Unreadable(..))));
    }
}
