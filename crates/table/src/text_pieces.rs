//! A text file read piece by piece and decoded at once, so that it is never whole in memory.

use super::door::open;
use super::encodings;
use super::file_error::FileError;
use super::stream::{self, is_stream};
use encoding_rs::{Decoder, Encoding, UTF_8, WINDOWS_1252};
use std::io::{Cursor, Read};
use std::path::Path;

/// What users call the encoding of Western Europe.
const WINDOWS_1252_NAME: &str = "Windows-1252";

/// Bytes that are read at once.
const PIECE: usize = 1 << 16;

/// Most bytes of a text that are held at once: no line is as long, and no text whose kind is asked for.
const LONGEST: usize = 256 << 20;

/// Bytes of a text that is no UTF-8 by which its encoding is judged.
const JUDGED: u64 = 1 << 20;

/// A text being read: UTF-8, UTF-16, else an [older encoding](encodings::of), most often Windows-1252.
pub(crate) struct TextPieces<'a> {
    /// The file, as messages call it.
    path: String,
    source: Box<dyn Read + 'a>,
    decoder: Decoder,
    /// The encoding, where it is not UTF-8.
    encoding: Option<&'static str>,
    /// Whether UTF-8 is but a guess, which bytes to come may refute.
    is_guess: bool,
    /// What has been read and not yet decoded.
    bytes: Vec<u8>,
    has_ended: bool,
}

/// Why no more text comes.
#[derive(Debug)]
pub(crate) enum PieceError {
    File(FileError),
    /// The guess was wrong: the text is in an [older encoding](TextPieces::in_older_encoding).
    NotUtf8,
}

impl<'a> TextPieces<'a> {
    /// A file from its beginning, or a stream.
    ///
    /// # Errors
    /// [`FileError`] if there is no file, it is a folder, or cannot be read.
    pub(crate) fn open(path: &Path) -> Result<Self, FileError> {
        let source: Box<dyn Read> = match is_stream(path) {
            true => Box::new(Cursor::new(stream::read(path, stream::LONGEST)?)),
            false => Box::new(open(path)?),
        };
        Self::of(path.display().to_string(), source)
    }

    /// A text that is there already.
    pub(crate) fn of_text(path: &str, text: &'a str) -> Self {
        let (source, decoder) = (Box::new(text.as_bytes()), UTF_8.new_decoder_without_bom_handling());
        let (path, bytes) = (path.to_owned(), Vec::new());
        Self { path, source, decoder, encoding: None, is_guess: false, bytes, has_ended: false }
    }

    fn of(path: String, mut source: Box<dyn Read + 'a>) -> Result<Self, FileError> {
        let mut bytes = Vec::with_capacity(PIECE);
        let read = source.by_ref().take(PIECE as u64).read_to_end(&mut bytes);
        read.map_err(|source| FileError::Unreadable { path: path.clone(), source })?;
        let marked = Encoding::for_bom(&bytes).or_else(|| Some((encodings::unmarked(&bytes)?, 0)));
        let (encoding, mark) = marked.unwrap_or((UTF_8, 0));
        bytes.drain(..mark);
        Ok(Self {
            path,
            source,
            decoder: encoding.new_decoder_without_bom_handling(),
            encoding: (encoding != UTF_8).then(|| encoding.name()),
            is_guess: marked.is_none(),
            bytes,
            has_ended: false,
        })
    }

    /// The same from its beginning in the encoding that its bytes suggest: this cannot fail.
    ///
    /// # Errors
    /// [`FileError`] if the file cannot be read.
    pub(crate) fn in_older_encoding(mut self) -> Result<Self, FileError> {
        let read = self.source.by_ref().take(JUDGED).read_to_end(&mut self.bytes);
        read.map_err(|source| FileError::Unreadable { path: self.path.clone(), source })?;
        let encoding = encodings::of(&self.bytes);
        let name = if encoding == WINDOWS_1252 { WINDOWS_1252_NAME } else { encoding.name() };
        let decoder = encoding.new_decoder_without_bom_handling();
        Ok(Self { decoder, encoding: Some(name), is_guess: false, ..self })
    }

    /// Whether it is read as Windows-1252, in which any bytes are letters.
    pub(crate) fn is_in_windows_1252(&self) -> bool {
        self.encoding == Some(WINDOWS_1252_NAME)
    }

    /// The encoding, where it is not UTF-8.
    pub(crate) fn encoding(&self) -> Option<&'static str> {
        self.encoding
    }

    /// The first bytes of the file, before anything is taken.
    pub(crate) fn first_bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Whether all has been taken.
    pub(crate) fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Appends what comes next.
    ///
    /// # Errors
    /// [`PieceError`] where the text is too long, the file cannot be read on, or is not UTF-8 where that was guessed.
    pub(crate) fn append_to(&mut self, text: &mut String) -> Result<(), PieceError> {
        if text.len() > LONGEST {
            let (path, most) = (self.path.clone(), LONGEST as u64);
            return Err(PieceError::File(FileError::TooLong { path, most }));
        }
        if self.bytes.is_empty() {
            let read = self.source.by_ref().take(PIECE as u64).read_to_end(&mut self.bytes);
            read.map_err(|source| {
                PieceError::File(FileError::Unreadable { path: self.path.clone(), source })
            })?;
        }
        self.has_ended = self.bytes.is_empty();
        text.reserve(self.decoder.max_utf8_buffer_length(self.bytes.len()).unwrap_or(4 * PIECE));
        let (.., has_errors) = self.decoder.decode_to_string(&self.bytes, text, self.has_ended);
        self.bytes.clear();
        if has_errors && self.is_guess { Err(PieceError::NotUtf8) } else { Ok(()) }
    }
}

/// The whole text of a file that measuring software wrote, in whatever encoding.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, or cannot be read.
pub fn read_decoded(path: &Path) -> Result<String, FileError> {
    let whole = |mut pieces: TextPieces<'_>| {
        let mut text = String::new();
        while !pieces.has_ended() {
            pieces.append_to(&mut text)?;
        }
        Ok(text)
    };
    match whole(TextPieces::open(path)?) {
        Err(PieceError::NotUtf8) => match whole(TextPieces::open(path)?.in_older_encoding()?) {
            Ok(text) => Ok(text),
            Err(PieceError::File(error)) => Err(error),
            Err(PieceError::NotUtf8) => Ok(String::new()),
        },
        Err(PieceError::File(error)) => Err(error),
        Ok(text) => Ok(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole(bytes: &[u8]) -> (String, Option<&'static str>) {
        let open = || TextPieces::of(String::new(), Box::new(bytes)).unwrap();
        let read = |mut pieces: TextPieces<'_>| {
            let mut text = String::new();
            while !pieces.has_ended() {
                pieces.append_to(&mut text)?;
            }
            Ok::<_, PieceError>((text, pieces.encoding()))
        };
        read(open()).or_else(|_| read(open().in_older_encoding().unwrap())).unwrap()
    }

    #[test]
    fn marks_are_dropped_and_encodings_reported() {
        let utf16: Vec<u8> = "\u{feff}t,µ".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(whole(&utf16), ("t,µ".to_owned(), Some("UTF-16LE")));
        let marked = [b"\xef\xbb\xbf".as_slice(), "t,µ".as_bytes()].concat();
        assert_eq!(whole(&marked), ("t,µ".to_owned(), None));
        assert_eq!(whole(b"t,\xb5\xb0"), ("t,µ°".to_owned(), Some("Windows-1252")));
    }

    #[test]
    fn letters_that_lie_across_pieces_are_whole() {
        for shift in 0..4 {
            let text = "x".repeat(shift) + &"µ€𝛑".repeat(PIECE / 4);
            assert_eq!(whole(text.as_bytes()), (text, None));
        }
        // A letter of Windows-1252 at the very end.
        let late = [vec![b'x'; 2 * PIECE], vec![0xb5]].concat();
        assert_eq!(whole(&late).1, Some("Windows-1252"));
    }
}
