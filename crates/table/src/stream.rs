//! Inputs that are no files on a disk: the standard input, pipes, FIFOs, devices.

use super::file_error::FileError;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};
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

/// Most bytes of any stream. As many hold five million rows, hours of what any rig measures; a device would give bytes for ever.
pub const LONGEST: u64 = 256 << 20;

/// Nobody waits longer for the first byte of a program that is at work on it.
const SILENCE: Duration = Duration::from_secs(10);

/// Why a stream could not be read.
#[derive(Debug, Clone)]
enum Fault {
    Silent,
    /// Beyond so many bytes.
    Endless(u64),
    /// The place of a zero byte in what should be text.
    Zero(usize),
    Unreadable(io::ErrorKind, String),
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error.kind(), error.to_string())
    }
}

/// The bytes of a stream, up to its end.
///
/// A command reads some files more than once, to see of which kind they are: what a stream gave is kept, and read on where more of it is wanted.
///
/// # Errors
/// A stream that is silent for 10 s, goes on beyond `most` bytes or [`LONGEST`], holds zero bytes but is of no kind that may, or cannot be read.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>, FileError> {
    static KEPT: Mutex<BTreeMap<PathBuf, Kept>> = Mutex::new(BTreeMap::new());
    let key = if is_standard_input(path) { Path::new(STANDARD_INPUT) } else { path };
    let mut all = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = all.entry(key.to_owned()).or_insert_with(|| {
        let owned = key.to_owned();
        match is_standard_input(key) {
            true => Kept::of(|| Ok(io::stdin()), SILENCE),
            false => Kept::of(move || File::open(owned), SILENCE),
        }
    });
    let bytes = kept.up_to(most.min(LONGEST), may_hold_zeros(path));
    let path = path.display().to_string();
    bytes.map_err(|fault| match fault {
        Fault::Silent => FileError::Silent { path, seconds: SILENCE.as_secs() },
        Fault::Endless(most) => FileError::Endless { path, mebibytes: most >> 20 },
        Fault::Zero(byte) => FileError::Zero { path, byte },
        Fault::Unreadable(kind, reported) => {
            FileError::Unreadable { path, source: io::Error::new(kind, reported) }
        }
    })
}

/// Whether a name says that a stream is no text.
fn may_hold_zeros(path: &Path) -> bool {
    let is = |ending: &OsStr| {
        ["mat", "mcap", "mf4", "parquet", "gz"].iter().any(|known| ending.eq_ignore_ascii_case(known))
    };
    path.extension().is_some_and(is)
}

/// Whether the first bytes say so: Parquet, UTF-16, MATLAB, HDF5, MCAP, MDF, gzip.
fn is_binary(bytes: &[u8]) -> bool {
    const SIGNATURES: [&[u8]; 9] = [
        b"PAR1",
        b"\xff\xfe",
        b"\xfe\xff",
        b"MATLAB ",
        b"\x89HDF",
        b"\x89MCAP",
        b"MDF     ",
        b"UnFinMF ",
        b"\x1f\x8b",
    ];
    SIGNATURES.iter().any(|signature| bytes.starts_with(signature))
}

/// A stream as far as it has been read.
struct Kept {
    bytes: Vec<u8>,
    more: Receiver<io::Result<Vec<u8>>>,
    /// How far the bytes are known to be text.
    looked_at: usize,
    end: Option<Result<(), Fault>>,
    silence: Duration,
}

impl Kept {
    /// Opening a FIFO waits for its writer, and a read for a byte, without end and beyond recall: another thread does both, and is left behind
    /// where nothing comes.
    fn of<R: Read>(open: impl FnOnce() -> io::Result<R> + Send + 'static, silence: Duration) -> Self {
        let (sender, more) = sync_channel(1);
        let pump = move || {
            let ended = open().and_then(|source| pass_on(source, &sender));
            // Nobody listens any more to what comes too late.
            let _ = ended.map_err(|error| sender.send(Err(error)));
        };
        let begun = thread::Builder::new().name("stream".to_owned()).spawn(pump);
        let end = begun.err().map(|error| Err(error.into()));
        Self { bytes: Vec::new(), more, looked_at: 0, end, silence }
    }

    /// All bytes, where there are no more than `most`.
    fn up_to(&mut self, most: u64, may_hold_zeros: bool) -> Result<Vec<u8>, Fault> {
        loop {
            if !may_hold_zeros {
                self.look()?;
            }
            if self.bytes.len() as u64 > most {
                return Err(Fault::Endless(most));
            }
            match &self.end {
                None => self.read_on(),
                Some(end) => return end.clone().map(|()| self.bytes.clone()),
            }
        }
    }

    fn read_on(&mut self) {
        match self.more.recv_timeout(self.silence) {
            Ok(Ok(chunk)) => self.bytes.extend(chunk),
            Ok(Err(error)) => self.end = Some(Err(error.into())),
            Err(RecvTimeoutError::Timeout) => self.end = Some(Err(Fault::Silent)),
            Err(RecvTimeoutError::Disconnected) => self.end = Some(Ok(())),
        }
    }

    /// Looks for zero bytes in what has come.
    fn look(&mut self) -> Result<(), Fault> {
        if !is_binary(&self.bytes) {
            if let Some(place) = self.bytes[self.looked_at..].iter().position(|byte| *byte == 0) {
                return Err(Fault::Zero(self.looked_at + place + 1));
            }
            self.looked_at = self.bytes.len();
        }
        Ok(())
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

    const SHORT: Duration = Duration::from_millis(200);

    fn drained<R: Read>(open: impl FnOnce() -> io::Result<R> + Send + 'static) -> Result<Vec<u8>, Fault> {
        Kept::of(open, SHORT).up_to(200_000, false)
    }

    #[test]
    fn a_stream_is_read_to_its_end_however_it_is_cut() {
        let (reader, mut writer) = pipe().unwrap();
        let text: Vec<u8> = (0..200_000_u32).map(|k| 1 + (k % 251) as u8).collect();
        let sent = text.clone();
        let sending =
            thread::spawn(move || sent.chunks(7_001).for_each(|part| writer.write_all(part).unwrap()));
        assert_eq!(drained(move || Ok(reader)).unwrap(), text);
        sending.join().unwrap();
    }

    #[test]
    fn a_stream_without_end_or_beginning_is_given_up() {
        assert!(matches!(drained(|| Ok(repeat(b'x'))), Err(Fault::Endless(200_000))));
        let (reader, writer) = pipe().unwrap();
        assert!(matches!(drained(move || Ok(reader)), Err(Fault::Silent)));
        drop(writer);
        let fails = || Err::<io::Empty, _>(io::Error::from(io::ErrorKind::PermissionDenied));
        assert!(matches!(drained(fails), Err(Fault::Unreadable(io::ErrorKind::PermissionDenied, _))));
    }

    #[test]
    fn zero_bytes_are_no_text_and_end_it_at_once() {
        let mut zeros = Kept::of(|| Ok(b"t,v\n".chain(repeat(0))), SHORT);
        assert!(matches!(zeros.up_to(u64::MAX, false), Err(Fault::Zero(5))));
        assert!(zeros.bytes.len() <= 2 << 16, "{} bytes were read", zeros.bytes.len());
        assert!(matches!(zeros.up_to(300_000, true), Err(Fault::Endless(300_000))));
        let utf16 =
            [b"\xff\xfe".as_slice(), &"t,v".encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<_>>()]
                .concat();
        let sent = utf16.clone();
        assert_eq!(drained(move || Ok(io::Cursor::new(sent))).unwrap(), utf16);
    }

    #[test]
    fn a_stream_is_read_on_where_more_is_wanted() {
        let mut kept = Kept::of(|| Ok(repeat(b'x').take(150_000)), SHORT);
        assert!(matches!(kept.up_to(1000, false), Err(Fault::Endless(1000))));
        assert_eq!(kept.up_to(200_000, false).unwrap().len(), 150_000);
        assert!(matches!(kept.up_to(1000, false), Err(Fault::Endless(1000))));
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
