//! Foreign processes, as the process sees them that began their guards.

use crate::folder;
use crate::messages::{End, Job, heard};
use crate::system;
use std::collections::{BTreeMap, VecDeque};
use std::ffi::OsString;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The last bytes that are kept of what an FMU prints.
const KEPT: usize = 1 << 16;

/// From one look at a guard to the next.
const LOOK: Duration = Duration::from_millis(2);

/// How long a guard may take to clear up.
pub(crate) const CLEARING: Duration = Duration::from_secs(8);

/// How it ended.
pub(crate) enum Ended {
    /// By itself; in words, how.
    Itself(String),
    /// Nothing had happened for too long.
    Silent,
}

/// All that is known of an FMU that was run.
pub(crate) struct Outcome {
    pub(crate) ended: Ended,
    pub(crate) said: End,
    /// The end of what the FMU printed.
    pub(crate) printed: String,
}

/// The standard input of a guard, which ends all that it guards where it is closed.
type Pipe = Arc<Mutex<Option<ChildStdin>>>;

/// The guards of this process by their numbers.
struct Guards {
    pipes: BTreeMap<u32, Pipe>,
    is_stopping: bool,
}

static GUARDS: Mutex<Guards> = Mutex::new(Guards { pipes: BTreeMap::new(), is_stopping: false });

fn guards() -> MutexGuard<'static, Guards> {
    GUARDS.lock().unwrap_or_else(PoisonError::into_inner)
}

fn close(pipe: &Pipe) {
    drop(pipe.lock().unwrap_or_else(PoisonError::into_inner).take());
}

/// Ends all foreign processes, and waits until nothing of them is left. Whoever runs one waits for ever: this process is to end.
pub fn stop() {
    let mut all = guards();
    all.is_stopping = true;
    all.pipes.values().for_each(close);
    drop(all);
    let begun = Instant::now();
    while !guards().pipes.is_empty() && begun.elapsed() < CLEARING {
        thread::sleep(LOOK);
    }
}

/// Runs an FMU over a job, as long as something happens within `patience`.
///
/// # Errors
/// If the system refuses a process.
pub(crate) fn run(fmu: &Path, job: &Job, patience: Duration) -> io::Result<Outcome> {
    let mut guard = Guard::begin(["fmu-host".into(), std::path::absolute(fmu)?.into()])?;
    let printed = guard.tail();
    let lengths = job.inputs.iter().map(Vec::len).collect();
    let news = listen(guard.output(), lengths);
    let text = serde_json::to_string(job).expect("numbers and words are JSON") + "\n";
    let _where_it_has_ended = guard.send(text.as_bytes());
    let mut is_silent = false;
    let said = loop {
        match news.recv_timeout(if is_silent { CLEARING } else { patience }) {
            Ok(News::GoesOn) => {}
            Ok(News::End(end)) => break end,
            Err(RecvTimeoutError::Timeout) if !is_silent => {
                is_silent = true;
                guard.release();
            }
            Err(_) => break End::default(),
        }
    };
    let status = guard.end()?;
    let ended = if is_silent { Ended::Silent } else { Ended::Itself(system::passed_on(status)) };
    Ok(Outcome { ended, said, printed: printed.recv_timeout(CLEARING).unwrap_or_default() })
}

/// What is heard of a simulation.
enum News {
    GoesOn,
    End(End),
}

/// Reads all that is said of records of these lengths.
fn listen(source: Option<ChildStdout>, lengths: Vec<usize>) -> Receiver<News> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let goes_on = || drop(sender.send(News::GoesOn));
        let source = source.map(BufReader::new);
        let end = source.map(|source| heard(&lengths, source, goes_on)).unwrap_or_default();
        let _where_nobody_waits = sender.send(News::End(end));
    });
    receiver
}

/// A guard that runs.
#[derive(Debug)]
pub(crate) struct Guard {
    child: Child,
    pipe: Pipe,
}

impl Guard {
    /// Begins this program once more, as a guard with these arguments.
    pub(crate) fn begin(arguments: impl IntoIterator<Item = OsString>) -> io::Result<Self> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(arguments);
        system::apart(&mut command).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut all = guards();
        let mut child = command.spawn()?;
        let pipe = Arc::new(Mutex::new(child.stdin.take().filter(|_| !all.is_stopping)));
        all.pipes.insert(child.id(), Arc::clone(&pipe));
        Ok(Self { child, pipe })
    }

    /// What those that it guards say by standard output; once.
    pub(crate) fn output(&mut self) -> Option<ChildStdout> {
        self.child.stdout.take()
    }

    /// Reads all that is printed to standard error, and gives the end of it.
    pub(crate) fn tail(&mut self) -> Receiver<String> {
        let (sender, receiver) = channel();
        let source = self.child.stderr.take();
        thread::spawn(move || {
            let _where_nobody_waits = sender.send(source.map(last_of).unwrap_or_default());
        });
        receiver
    }

    /// Sends bytes to those that it guards.
    ///
    /// # Errors
    /// Where it has ended, or is to end.
    pub(crate) fn send(&self, bytes: &[u8]) -> io::Result<()> {
        let mut pipe = self.pipe.lock().unwrap_or_else(PoisonError::into_inner);
        pipe.as_mut().ok_or(io::ErrorKind::BrokenPipe)?.write_all(bytes)
    }

    /// Has it end all that it guards.
    pub(crate) fn release(&self) {
        close(&self.pipe);
    }

    /// Waits until it has cleared up.
    pub(crate) fn end(mut self) -> io::Result<ExitStatus> {
        self.release();
        let begun = Instant::now();
        let status = loop {
            match self.child.try_wait() {
                Ok(None) if begun.elapsed() < CLEARING => thread::sleep(LOOK),
                Ok(None) => drop(self.child.kill()),
                Ok(Some(status)) => break Ok(status),
                Err(error) => break Err(error),
            }
        };
        // A guard that was killed has left its folder.
        if status.as_ref().is_ok_and(|status| status.code().is_none()) {
            folder::sweep();
        }
        let mut all = guards();
        all.pipes.remove(&self.child.id());
        let is_stopping = all.is_stopping;
        drop(all);
        // Another thread ends the process: nobody shall take this for a failure of theirs.
        if is_stopping {
            loop {
                thread::park();
            }
        }
        status
    }
}

/// The end of a text that may have any length.
fn last_of(mut source: impl Read) -> String {
    let (mut kept, mut chunk) = (VecDeque::with_capacity(2 * KEPT), vec![0; KEPT]);
    while let Ok(count @ 1..) = source.read(&mut chunk) {
        kept.extend(&chunk[..count]);
        kept.drain(..kept.len().saturating_sub(KEPT));
    }
    String::from_utf8_lossy(kept.make_contiguous()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_what_is_printed_the_end_is_kept() {
        assert_eq!(last_of("a\nb".as_bytes()), "a\nb");
        let long = io::repeat(b'x').take(5 * KEPT as u64 + 7).chain("the end".as_bytes());
        let kept = last_of(long);
        assert!(kept.len() == KEPT && kept.ends_with("xxthe end"), "{}", kept.len());
    }
}
