//! From a file's bytes to text: UTF-8, UTF-16 with a byte order mark, else Windows-1252.

use super::text_file::{FileError, read_bytes};
use encoding_rs::{Encoding, WINDOWS_1252};
use std::path::Path;

/// A file's text and, where it was not UTF-8, the encoding it was read as.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Decoded {
    pub(crate) text: String,
    pub(crate) encoding: Option<&'static str>,
}

/// Reads a file that measuring software wrote, in whatever encoding.
///
/// # Errors
/// [`FileError`] if there is no file, it is a folder, or cannot be read.
pub(crate) fn read_decoded(path: &Path) -> Result<Decoded, FileError> {
    Ok(decode(read_bytes(path)?))
}

/// Every byte means a letter in Windows-1252 (its printable part is Latin-1), so this cannot fail.
pub(super) fn decode(bytes: Vec<u8>) -> Decoded {
    if let Some((encoding, mark)) = Encoding::for_bom(&bytes) {
        let (text, _) = encoding.decode_without_bom_handling(&bytes[mark..]);
        let told = (encoding != encoding_rs::UTF_8).then(|| encoding.name());
        return Decoded { text: text.into_owned(), encoding: told };
    }
    match String::from_utf8(bytes) {
        Ok(text) => Decoded { text, encoding: None },
        Err(error) => {
            let (text, _) = WINDOWS_1252.decode_without_bom_handling(error.as_bytes());
            Decoded { text: text.into_owned(), encoding: Some("Windows-1252") }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_dropped_and_encodings_told() {
        let utf16: Vec<u8> = "\u{feff}t,µ".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(decode(utf16), Decoded { text: "t,µ".to_owned(), encoding: Some("UTF-16LE") });
        let marked = [b"\xef\xbb\xbf".as_slice(), "t,µ".as_bytes()].concat();
        assert_eq!(decode(marked), Decoded { text: "t,µ".to_owned(), encoding: None });
        let latin = Decoded { text: "t,µ°".to_owned(), encoding: Some("Windows-1252") };
        assert_eq!(decode(b"t,\xb5\xb0".to_vec()), latin);
    }
}
