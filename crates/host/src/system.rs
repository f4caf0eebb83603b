//! Calls of the operating system that tie processes to each other. On systems without one of them the call does nothing.

use std::process::{Child, Command, ExitStatus};
use std::time::{Duration, Instant};

/// Most bytes of a file that a simulation may write: room for its protocol, too little to fill a disk by accident.
#[cfg(unix)]
const LARGEST_FILE: u64 = 64 << 20;

/// Most bytes of memory that a simulation may fill, beside its code.
#[cfg(unix)]
const LARGEST_DATA: u64 = 8 << 30;

/// How long killed processes may take to end.
const PATIENCE: Duration = Duration::from_secs(5);

/// A process that signals to this one's group, as from the keyboard, do not reach.
pub(crate) fn apart(command: &mut Command) -> &mut Command {
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        command.process_group(0);
    }
    command
}

/// Makes this process the parent of all its descendants whose own parents end.
pub(crate) fn adopt_orphans() {
    #[cfg(target_os = "linux")]
    let _where_the_kernel_is_old = rustix::process::set_child_subreaper(Some(rustix::process::getpid()));
}

/// Ends this process as soon as its parent ends.
pub(crate) fn end_with_parent() {
    #[cfg(target_os = "linux")]
    let _where_the_kernel_is_old =
        rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL));
}

/// Limits the memory of this process, and the size of each file that it writes. It leaves no image of its memory where it crashes.
pub(crate) fn limit() {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
        for (resource, most) in
            [(Resource::Core, 0), (Resource::Fsize, LARGEST_FILE), (Resource::Data, LARGEST_DATA)]
        {
            let most = getrlimit(resource).maximum.map_or(most, |found| found.min(most));
            let _where_it_has_none = setrlimit(resource, Rlimit { current: Some(most), maximum: Some(most) });
        }
    }
}

/// The pipe that standard output is, which from here on is what standard error is: what a library prints is kept apart from it.
#[cfg(unix)]
pub(crate) fn take_standard_output() -> std::io::Result<std::fs::File> {
    let own = rustix::io::fcntl_dupfd_cloexec(std::io::stdout(), 3)?;
    rustix::stdio::dup2_stdout(std::io::stderr())?;
    Ok(own.into())
}

/// Elsewhere the two stay one.
#[cfg(not(unix))]
pub(crate) fn take_standard_output() -> std::io::Result<std::io::Stdout> {
    Ok(std::io::stdout())
}

/// Ends a child, those of its group, and all processes that were adopted from them.
pub(crate) fn end_all(child: &mut Child) {
    #[cfg(unix)]
    if let Some(group) = i32::try_from(child.id()).ok().and_then(rustix::process::Pid::from_raw) {
        let _where_it_is_empty = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
    }
    let _where_it_has_ended = child.kill();
    let _ = child.wait();
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE && end_adopted() {
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Kills all children of this process, and takes note of those that have ended; whether there are any left.
#[cfg(target_os = "linux")]
fn end_adopted() -> bool {
    use rustix::process::{Pid, Signal, WaitOptions, kill_process, wait};
    let own = std::process::id();
    let parent = |id: &i32| {
        let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
        // `NUMBER (NAME) STATE PARENT …`, where a name may hold anything.
        stat.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse::<u32>().ok()
    };
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let numbers = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<i32>().ok());
    for id in numbers.filter(|id| parent(id) == Some(own)) {
        let _where_it_has_ended = Pid::from_raw(id).map(|id| kill_process(id, Signal::KILL));
    }
    loop {
        match wait(WaitOptions::NOHANG) {
            Ok(Some(_)) => {}
            Ok(None) => return true,
            Err(_) => return false,
        }
    }
}

/// Elsewhere none are adopted.
#[cfg(not(target_os = "linux"))]
fn end_adopted() -> bool {
    false
}

/// What a guard's exit code is where a signal ended the simulation: as in a shell, so much more than its number.
const SIGNALLED: i32 = 128;

/// The exit code by which a guard passes on how a process ended.
pub(crate) fn code(status: ExitStatus) -> u8 {
    #[cfg(unix)]
    let signal = std::os::unix::process::ExitStatusExt::signal(&status);
    #[cfg(not(unix))]
    let signal: Option<i32> = None;
    let code = status.code().or(signal.map(|signal| SIGNALLED + signal));
    code.and_then(|code| u8::try_from(code).ok()).unwrap_or(1)
}

/// How the process ended whose guard ended so.
pub(crate) fn passed_on(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) =
        status.code().and_then(|code| code.checked_sub(SIGNALLED)).filter(|signal| *signal > 0)
    {
        use std::os::unix::process::ExitStatusExt;
        return ExitStatus::from_raw(signal).to_string();
    }
    status.to_string()
}
