//! From the address of the resources to their folder.

use std::path::PathBuf;

/// The folder at a `file:` address, `%20` and its like undone; none for an address of another kind. A plain path is taken as it is.
///
/// ```
/// use std::path::PathBuf;
/// use switchback_fmu::path_of;
/// assert_eq!(path_of("file:///tmp/a%20b/100%25"), Some(PathBuf::from("/tmp/a b/100%")));
/// assert_eq!(path_of("file:/tmp/r"), Some(PathBuf::from("/tmp/r")));
/// assert_eq!(path_of("file://localhost/tmp/r"), Some(PathBuf::from("/tmp/r")));
/// assert_eq!(path_of("http://host/r"), None);
/// ```
pub fn path_of(address: &str) -> Option<PathBuf> {
    let Some(rest) = address.strip_prefix("file:") else {
        return (!address.contains("://")).then(|| PathBuf::from(address));
    };
    let path = match rest.strip_prefix("//") {
        Some(after) if after.starts_with('/') => after,
        Some(after) => after.strip_prefix("localhost")?,
        None => rest,
    };
    let path = decoded(path)?;
    // A Windows path has its drive after the first slash.
    let drive = path.strip_prefix('/').filter(|path| path.as_bytes().get(1) == Some(&b':'));
    Some(PathBuf::from(drive.map_or(path.clone(), str::to_owned)))
}

fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = (*first == b'%').then(|| tail.get(..2)).flatten();
        let code = code.and_then(|code| u8::from_str_radix(std::str::from_utf8(code).ok()?, 16).ok());
        match code {
            Some(byte) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            // Some callers forget to write a `%` as `%25`.
            None => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).ok()
}
