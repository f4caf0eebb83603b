//! The process between a diagnosis and an FMU, which leaves nothing of the FMU behind.

use crate::system;
use std::fs::Permissions;
use std::io::{self, BufRead, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
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
    let folder = folder()?;
    let mut simulation = begin(fmu, folder.path())?;
    let is_left = Arc::new(AtomicBool::new(false));
    pass_on_the_job(&mut simulation, is_left.clone());
    let ended = loop {
        if let Some(status) = simulation.try_wait()? {
            break Some(status);
        }
        if is_left.load(Ordering::SeqCst) || is_stopped() {
            break None;
        }
        thread::sleep(LOOK);
    };
    system::end_all(&mut simulation);
    let status = ended.map_or(1, system::code);
    folder.close().map(|()| status)
}

/// A folder that nobody else can read.
fn folder() -> io::Result<tempfile::TempDir> {
    let mut named = tempfile::Builder::new();
    named.prefix("switchback-fmu-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        named.permissions(Permissions::from_mode(0o700)).tempdir()
    }
    #[cfg(not(unix))]
    named.tempdir()
}

fn begin(fmu: &Path, folder: &Path) -> io::Result<Child> {
    let mut command = Command::new(std::env::current_exe()?);
    // What the FMU keeps for a while goes where it is removed.
    command.args(["fmu-host", "--inside"]).arg(fmu).current_dir(folder).env("TMPDIR", folder);
    system::apart(&mut command).stdin(Stdio::piped()).spawn()
}

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
