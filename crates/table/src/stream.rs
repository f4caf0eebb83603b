//! Inputs that are no files on a disk: the standard input, pipes, FIFOs, devices.

use super::file_error::FileError;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// The standard input, as a path on the command line.
const STANDARD_INPUT: &str = "-";

/// Whether a path leads to a stream rather than a file or folder: it can be read only once, may never end, and may never begin.
pub fn is_stream(path: &Path) -> bool {
    let is_special = || path.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir());
    is_standard_input(path) || is_special()
}

fn is_standard_input(path: &Path) -> bool {
    path == Path::new(STANDARD_INPUT) || path == Path::new("/dev/stdin")
}

/// What is named after a file: the file's name without its ending; `stdin`, and `stream` for what else has no name of its own.
pub fn stem(path: &Path) -> Option<String> {
    // A process substitution is a number in here.
    let is_unnamed = ["/dev", "/proc"].iter().any(|folder| path.starts_with(folder)) && is_stream(path);
    match is_standard_input(path) {
        true => Some("stdin".to_owned()),
        false if is_unnamed => Some("stream".to_owned()),
        false => path.file_stem().map(|stem| stem.to_string_lossy().into_owned()),
    }
}

/// What a command line that makes the same again calls a file: its name, without the place where this machine keeps it; `-` for a stream.
pub fn file_name(path: &Path) -> String {
    let name =
        if is_stream(path) { OsStr::new(STANDARD_INPUT) } else { path.file_name().unwrap_or_default() };
    name.to_string_lossy().into_owned()
}

/// The same for a copy of it.
pub fn copy_name(path: &Path) -> String {
    let of_stream = || stem(path).unwrap_or_default() + ".toml";
    if is_stream(path) { of_stream() } else { file_name(path) }
}

/// The folder that names in a file are relative to: its own; the working one for a stream.
pub fn folder(path: &Path) -> &Path {
    let own = if is_stream(path) { None } else { path.parent() };
    own.unwrap_or(Path::new(""))
}

/// What is asked of a stream.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    /// Most bytes.
    bytes: usize,
    /// Longest time without a byte.
    silence: Duration,
}

/// A billion bytes hold ten million rows, hours of what any rig measures; a device would give bytes for ever. Nobody waits ten seconds for the
/// first byte of a program that is at work on it.
const BOUNDS: Bounds = Bounds { bytes: 1 << 30, silence: Duration::from_secs(10) };

/// Why a stream could not be read.
#[derive(Debug, Clone)]
enum Fault {
    Silent,
    Endless,
    Unreadable(io::ErrorKind, String),
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error.kind(), error.to_string())
    }
}

/// The bytes of a stream, up to its end.
///
/// A command reads some files more than once, to see of which kind they are: what a stream gave is kept.
///
/// # Errors
/// A stream that is silent for 10 s, goes on beyond 1 GiB, or cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    type Kept = Result<Arc<Vec<u8>>, Fault>;
    static KEPT: Mutex<BTreeMap<PathBuf, Kept>> = Mutex::new(BTreeMap::new());
    let key = if is_standard_input(path) { Path::new(STANDARD_INPUT) } else { path };
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let bytes = kept.entry(key.to_owned()).or_insert_with(|| {
        let owned = key.to_owned();
        let bytes = if is_standard_input(key) {
            drain(|| Ok(io::stdin()), BOUNDS)
        } else {
            drain(move || File::open(owned), BOUNDS)
        };
        bytes.map(Arc::new)
    });
    let path = path.display().to_string();
    match bytes {
        Ok(bytes) => Ok(bytes.to_vec()),
        Err(Fault::Silent) => Err(FileError::Silent { path, seconds: BOUNDS.silence.as_secs() }),
        Err(Fault::Endless) => Err(FileError::Endless { path, gibibytes: BOUNDS.bytes >> 30 }),
        Err(Fault::Unreadable(kind, reported)) => {
            Err(FileError::Unreadable { path, source: io::Error::new(*kind, reported.clone()) })
        }
    }
}

/// Reads to the end. Opening a FIFO waits for its writer, and a read for a byte, without end and beyond recall: another thread does both, and is
/// left behind where nothing comes.
fn drain<R: Read>(
    open: impl FnOnce() -> io::Result<R> + Send + 'static,
    bounds: Bounds,
) -> Result<Vec<u8>, Fault> {
    let (sender, receiver) = sync_channel(1);
    let pump = move || {
        let ended = open().and_then(|source| pass_on(source, &sender));
        // Nobody listens any more to what comes too late.
        let _ = ended.map_err(|error| sender.send(Err(error)));
    };
    thread::Builder::new().name("stream".to_owned()).spawn(pump)?;
    let mut bytes = Vec::new();
    loop {
        match receiver.recv_timeout(bounds.silence) {
            Ok(chunk) => bytes.extend(chunk?),
            Err(RecvTimeoutError::Timeout) => return Err(Fault::Silent),
            Err(RecvTimeoutError::Disconnected) => return Ok(bytes),
        }
        if bytes.len() > bounds.bytes {
            return Err(Fault::Endless);
        }
    }
}

/// Sends what a source gives, until its end or until nobody listens.
fn pass_on(mut source: impl Read, sender: &SyncSender<io::Result<Vec<u8>>>) -> io::Result<()> {
    /// What a pipe of Linux holds.
    const CHUNK: usize = 1 << 16;
    loop {
        let mut chunk = vec![0; CHUNK];
        match source.read(&mut chunk) {
            Ok(0) => return Ok(()),
            Ok(count) => chunk.truncate(count),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        }
        if sender.send(Ok(chunk)).is_err() {
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Write, pipe, repeat};

    const SMALL: Bounds = Bounds { bytes: 200_000, silence: Duration::from_millis(200) };

    #[test]
    fn a_stream_is_read_to_its_end_however_it_is_cut() {
        let (reader, mut writer) = pipe().unwrap();
        let text: Vec<u8> = (0..200_000_u32).map(|k| (k % 251) as u8).collect();
        let sent = text.clone();
        let sending =
            thread::spawn(move || sent.chunks(7_001).for_each(|part| writer.write_all(part).unwrap()));
        assert_eq!(drain(move || Ok(reader), SMALL).unwrap(), text);
        sending.join().unwrap();
    }

    #[test]
    fn a_stream_without_end_or_beginning_is_given_up() {
        assert!(matches!(drain(|| Ok(repeat(0)), SMALL), Err(Fault::Endless)));
        let (reader, writer) = pipe().unwrap();
        assert!(matches!(drain(move || Ok(reader), SMALL), Err(Fault::Silent)));
        drop(writer);
        let fails = || Err::<io::Empty, _>(io::Error::from(io::ErrorKind::PermissionDenied));
        assert!(matches!(drain(fails, SMALL), Err(Fault::Unreadable(io::ErrorKind::PermissionDenied, _))));
    }

    #[test]
    fn streams_get_names_that_say_something() {
        let reported = |path: &str| stem(Path::new(path)).unwrap();
        assert_eq!((reported("-").as_str(), reported("/dev/stdin").as_str()), ("stdin", "stdin"));
        assert_eq!((reported("./-").as_str(), reported("bench/a.csv").as_str()), ("-", "a"));
        assert_eq!(
            (file_name(Path::new("-")).as_str(), file_name(Path::new("b/a.toml")).as_str()),
            ("-", "a.toml")
        );
    }
}
