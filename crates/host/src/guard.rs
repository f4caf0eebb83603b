//! The process between this program and foreign code, which leaves nothing of it behind.

use crate::folder::PrivateFolder;
use crate::system;
use std::ffi::OsString;
use std::io::{self, BufRead, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// From one look at the simulation to the next.
const LOOK: Duration = Duration::from_millis(5);

/// Most bytes of a job: the numbers of as many samples as are read from a stream.
const LARGEST_JOB: u64 = 4 << 30;

/// Runs an FMU in a process and a folder of their own: the job is the first line of standard input. When the process ends, when standard input
/// does (as it does when the process at its other end has ended), or when `is_stopped`, every process that the FMU began is ended and the folder
/// removed. The result is the exit code of the simulation.
///
/// # Errors
/// If there can be no such folder or process, or it is given no job.
pub fn guard(fmu: &Path, is_stopped: impl Fn() -> bool) -> io::Result<u8> {
    system::adopt_orphans();
    let folder = PrivateFolder::new("fmu")?;
    let mut simulation = begin(fmu, folder.path())?;
    let is_left = Arc::new(AtomicBool::new(false));
    pass_on_the_job(&mut simulation, is_left.clone());
    let status = watched(simulation, &is_left, is_stopped)?;
    folder.close().map(|()| status)
}

/// Runs a command in a process of its own: what comes by standard input is passed on to it. When the process ends, when standard input does (as
/// it does when the process at its other end has ended), or when `is_stopped`, every process that the command began is ended and the folder,
/// which is there already, removed. The result is the exit code of the command.
///
/// # Errors
/// If there can be no such process.
pub fn guard_command(command: &[OsString], folder: &Path, is_stopped: impl Fn() -> bool) -> io::Result<u8> {
    system::adopt_orphans();
    let begun = begin_command(command, folder);
    let status = begun.and_then(|mut process| {
        let is_left = Arc::new(AtomicBool::new(false));
        pass_everything_on(&mut process, is_left.clone());
        watched(process, &is_left, is_stopped)
    });
    std::fs::remove_dir_all(folder).and(status)
}

/// Becomes a command that ends with its parent.
///
/// # Errors
/// If there is no such command.
pub fn become_command(command: &[OsString]) -> io::Error {
    system::end_with_parent();
    let Some((program, arguments)) = command.split_first() else {
        return io::Error::from(io::ErrorKind::NotFound);
    };
    let mut next = Command::new(program);
    next.args(arguments);
    #[cfg(unix)]
    return std::os::unix::process::CommandExt::exec(&mut next);
    #[cfg(not(unix))]
    match next.status() {
        Ok(status) => std::process::exit(status.code().unwrap_or(1)),
        Err(error) => error,
    }
}

/// Waits until a process ends, or is to end, and ends all that it began.
fn watched(mut process: Child, is_left: &AtomicBool, is_stopped: impl Fn() -> bool) -> io::Result<u8> {
    let ended = loop {
        if let Some(status) = process.try_wait()? {
            break Some(status);
        }
        if is_left.load(Ordering::SeqCst) || is_stopped() {
            break None;
        }
        thread::sleep(LOOK);
    };
    system::end_all(&mut process);
    Ok(ended.map_or(1, system::code))
}

fn begin(fmu: &Path, folder: &Path) -> io::Result<Child> {
    let mut command = Command::new(std::env::current_exe()?);
    // What the FMU keeps for a while goes where it is removed.
    command.args(["fmu-host", "--inside"]).arg(fmu).current_dir(folder).env("TMPDIR", folder);
    system::apart(&mut command).stdin(Stdio::piped()).spawn()
}

fn begin_command(words: &[OsString], folder: &Path) -> io::Result<Child> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["method-host", "--inside"]).arg(folder).args(words).env("TMPDIR", folder);
    // As many processes run as there are threads: each computes on one, unless the user says otherwise.
    for name in THREADS.into_iter().filter(|name| std::env::var_os(name).is_none()) {
        command.env(name, "1");
    }
    system::apart(&mut command).stdin(Stdio::piped()).spawn()
}

/// Variables that set the number of threads of numerical libraries.
const THREADS: [&str; 4] =
    ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "JULIA_NUM_THREADS"];

/// Passes all on that comes by standard input. What the process has not read yet is kept here, so that whoever writes never waits for it.
fn pass_everything_on(process: &mut Child, is_left: Arc<AtomicBool>) {
    let (sender, receiver) = channel::<Vec<u8>>();
    let to = process.stdin.take();
    thread::spawn(move || {
        // Where the process has ended, it reads no more.
        to.map(|mut to| receiver.into_iter().all(|bytes| to.write_all(&bytes).is_ok()))
    });
    thread::spawn(move || {
        let (mut from, mut chunk) = (io::stdin().lock(), vec![0; CHUNK]);
        while let Ok(count @ 1..) = from.read(&mut chunk) {
            let _where_it_has_ended = sender.send(chunk[..count].to_vec());
        }
        is_left.store(true, Ordering::SeqCst);
    });
}

/// Bytes that are passed on at once.
const CHUNK: usize = 1 << 16;

/// Passes the first line on, and waits for the end of what comes behind it.
fn pass_on_the_job(simulation: &mut Child, is_left: Arc<AtomicBool>) {
    let to = simulation.stdin.take();
    let listening = move || {
        let mut from = io::stdin().lock();
        let mut job = Vec::new();
        let whole = from.by_ref().take(LARGEST_JOB).read_until(b'\n', &mut job);
        if whole.is_ok() && job.ends_with(b"\n") {
            // Where the simulation has ended, it reads no more.
            let _ = to.map(|mut to| to.write_all(&job));
            let _ = io::copy(&mut from, &mut io::sink());
        }
        is_left.store(true, Ordering::SeqCst);
    };
    thread::spawn(listening);
}
