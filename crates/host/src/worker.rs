//! A command that reads lines and answers by lines, in a process of its own.

use crate::folder::PrivateFolder;
use crate::process::{CLEARING, Guard};
use crate::system;
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::ChildStdout;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

/// Lines that may wait to be heard: who prints more waits itself.
const WAITING: usize = 1024;

/// What is heard of a worker.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Heard {
    /// A line, without its end; the first bytes of one that is too long.
    Line(Vec<u8>),
    /// Nothing within the time given.
    Nothing,
    /// No more will be: it closed its output.
    End,
}

/// A command that runs. It ends with this process, and with it all that it began.
#[derive(Debug)]
pub struct Worker {
    guard: Guard,
    heard: Receiver<Vec<u8>>,
    printed: Receiver<String>,
    block: File,
    place: PathBuf,
    /// The guard removes it, and this process where the guard was killed.
    _folder: PrivateFolder,
}

impl Worker {
    /// Begins a command in the working folder of this process; no line that it says is longer than `longest` bytes.
    ///
    /// # Errors
    /// If the system refuses a process or a folder.
    pub fn begin(command: &[String], longest: usize) -> io::Result<Self> {
        let folder = PrivateFolder::new("method")?;
        let place = folder.path().join("block");
        let block = File::create_new(&place)?;
        let words = command.iter().map(OsString::from);
        let arguments = [OsString::from("method-host"), folder.path().into()].into_iter().chain(words);
        let mut guard = Guard::begin(arguments)?;
        let printed = guard.tail();
        let heard = listen(guard.output(), longest);
        Ok(Self { guard, heard, printed, block, place, _folder: folder })
    }

    /// A file for numbers that lines speak of: in a folder that nobody else reads, removed when the worker ends.
    pub fn block(&self) -> &Path {
        &self.place
    }

    /// Writes bytes into that file, from a place on.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn write(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        self.block.seek(SeekFrom::Start(place))?;
        self.block.write_all(bytes)
    }

    /// Sends lines.
    ///
    /// # Errors
    /// If it has ended.
    pub fn send(&self, lines: &str) -> io::Result<()> {
        self.guard.send(lines.as_bytes())
    }

    /// The next that is heard of it.
    pub fn hear(&self, patience: Duration) -> Heard {
        match self.heard.recv_timeout(patience) {
            Ok(line) => Heard::Line(line),
            Err(RecvTimeoutError::Timeout) => Heard::Nothing,
            Err(RecvTimeoutError::Disconnected) => Heard::End,
        }
    }

    /// Ends it, with all that it began: how it ended where it had ended by itself, and the end of what it printed to standard error.
    ///
    /// # Errors
    /// If the system does not say.
    pub fn end(self) -> io::Result<(String, String)> {
        let Self { guard, heard, printed, .. } = self;
        // Who waits to say more need not wait.
        drop(heard);
        let status = guard.end()?;
        Ok((system::passed_on(status), printed.recv_timeout(CLEARING).unwrap_or_default()))
    }
}

/// Reads all lines.
fn listen(source: Option<ChildStdout>, longest: usize) -> Receiver<Vec<u8>> {
    let (sender, receiver) = sync_channel(WAITING);
    thread::spawn(move || source.map(|source| lines(BufReader::new(source), longest, &sender)));
    receiver
}

/// Hands over each line; of one that is too long its beginning, and nothing after it. What is read when nobody listens any more is dropped.
fn lines(mut source: impl BufRead, longest: usize, sender: &SyncSender<Vec<u8>>) {
    loop {
        let mut line = Vec::new();
        let read = source.by_ref().take(longest as u64).read_until(b'\n', &mut line);
        let is_whole = line.pop_if(|last| *last == b'\n').is_some();
        let is_over = read.is_err() || !is_whole;
        if is_over && line.is_empty() {
            return;
        }
        if sender.send(line).is_err() {
            break;
        }
        if is_over {
            break;
        }
    }
    let _ = io::copy(&mut source, &mut io::sink());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(text: &str, longest: usize) -> Vec<String> {
        let (sender, receiver) = sync_channel(WAITING);
        lines(text.as_bytes(), longest, &sender);
        drop(sender);
        receiver.into_iter().map(|line| String::from_utf8(line).expect("text")).collect()
    }

    #[test]
    fn lines_come_one_by_one_and_none_is_longer_than_allowed() {
        assert_eq!(heard("a\n\nbc\n", 9), ["a", "", "bc"]);
        assert_eq!(heard("a\nhalf", 9), ["a", "half"]);
        assert_eq!(heard("a\nmuch too long\nb\n", 9), ["a", "much too "]);
        assert!(heard("", 9).is_empty());
    }
}
