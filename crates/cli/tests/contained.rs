//! What an FMU does to the machine by accident: nothing of it is left, and what it prints is bounded.
#![cfg(target_os = "linux")]

use crate::common::{Folder, listing};
use crate::fmu::{DESCRIPTION, archive};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Rigs and a folder for what is temporary, in which nothing may be left.
struct Place(Folder);

impl Place {
    fn new() -> Self {
        let place = Self(Folder::with_good_rig());
        fs::create_dir(place.0.path("temporary")).expect("a folder");
        place
    }

    /// An FMU whose tenth step runs this C code; none where there is no compiler.
    fn fmu(&self, code: &str) -> Option<()> {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmu/accident.c");
        let library = self.0.path("hand.so");
        let mut compiler = Command::new("cc");
        compiler.args(["-w", "-shared", "-fPIC", "-O1", &format!("-DSTEP={code}")]).arg(source);
        let Ok(made) = compiler.arg("-o").arg(&library).output() else {
            eprintln!("SKIPPED: there is no C compiler `cc`");
            return None;
        };
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        let binary = format!("binaries/{}/hand.so", switchback_io::export::platform());
        let library = fs::read(library).expect("built");
        archive(
            &self.0.path("hand.fmu"),
            &[("modelDescription.xml", DESCRIPTION.as_bytes().to_vec()), (&binary, library)],
        );
        Some(())
    }

    fn gap(&self, patience: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_switchback"));
        let arguments = ["gap", "rig.toml", "--fmu", "hand.fmu", "--map", "v=position,y=force", "--quiet"];
        command.args(arguments).args(["--patience", patience]);
        command.current_dir(self.0.path(".")).env("TMPDIR", self.temporary());
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    fn temporary(&self) -> std::path::PathBuf {
        fs::canonicalize(self.0.path("temporary")).expect("a folder")
    }

    /// Processes that were begun with this place's temporary folder in their environment.
    fn processes(&self) -> Vec<String> {
        let place = self.temporary().display().to_string();
        let mut found = Vec::new();
        for entry in fs::read_dir("/proc").expect("/proc").flatten() {
            let of = |file: &str| fs::read(entry.path().join(file)).unwrap_or_default();
            if String::from_utf8_lossy(&of("environ")).contains(&place) {
                found.push(String::from_utf8_lossy(&of("cmdline")).replace('\0', " "));
            }
        }
        found
    }

    #[track_caller]
    fn nothing_is_left(&self, within: Duration) {
        let begun = Instant::now();
        let left = || (self.processes(), listing(&self.temporary()));
        while left() != (Vec::new(), Vec::new()) && begun.elapsed() < within {
            sleep(Duration::from_millis(5));
        }
        assert_eq!(left(), (Vec::new(), Vec::new()));
    }

    /// Waits until the FMU stands in its tenth step.
    fn wait_for_step(&self, process: &mut Child) {
        let begun = Instant::now();
        let is_there = || {
            let folders = listing(&self.temporary());
            folders.iter().any(|folder| self.temporary().join(folder).join("stands").exists())
        };
        while !is_there() {
            assert!(process.try_wait().expect("ours").is_none(), "it ended before");
            assert!(begun.elapsed() < Duration::from_secs(60), "it does not come to its tenth step");
            sleep(Duration::from_millis(5));
        }
    }
}

const SPIN: &str = "for(;;)n=10";
const DAEMON: &str =
    "if(!fork()){setsid();if(!fork()){setsid();for(;;)pause();}_exit(0);}else for(;;)pause()";

#[test]
fn a_signal_to_the_diagnosis_ends_the_fmu_and_removes_its_folder() {
    let place = Place::new();
    for code in [SPIN, DAEMON] {
        if place.fmu(code).is_none() {
            return;
        }
        for (signal, at_once) in [("-TERM", true), ("-INT", true), ("-KILL", false)] {
            let mut process = place.gap("60").spawn().expect("it starts");
            place.wait_for_step(&mut process);
            let folder = place.temporary().join(&listing(&place.temporary())[0]);
            let mode = fs::metadata(folder).expect("a folder").permissions().mode();
            assert_eq!(mode & 0o777, 0o700, "nobody else reads it");
            let sent = Command::new("kill").args([signal, &process.id().to_string()]).status();
            assert!(sent.expect("kill").success());
            let code = process.wait().expect("it ends").code();
            assert_eq!(code, at_once.then_some(3), "{signal}");
            place.nothing_is_left(if at_once { Duration::ZERO } else { Duration::from_secs(10) });
        }
    }
}

#[test]
fn a_guard_that_is_told_to_stop_clears_up_first() {
    let place = Place::new();
    if place.fmu(DAEMON).is_none() {
        return;
    }
    let mut process = place.gap("60").spawn().expect("it starts");
    place.wait_for_step(&mut process);
    let guard = child(process.id()).expect("a guard").to_string();
    let sent = Command::new("kill").args(["-TERM", &guard]).status().expect("kill");
    assert!(sent.success());
    assert_eq!(process.wait().expect("it ends").code(), Some(2));
    place.nothing_is_left(Duration::ZERO);
}

/// Sends a signal to a process that is there.
fn signal(signal: &str, id: u32) {
    assert!(Command::new("kill").args([signal, &id.to_string()]).status().expect("kill").success());
}

#[test]
fn the_folder_of_a_guard_that_was_killed_is_removed_by_the_diagnosis_or_the_next() {
    let place = Place::new();
    if place.fmu(SPIN).is_none() {
        return;
    }
    let mut process = place.gap("60").spawn().expect("it starts");
    place.wait_for_step(&mut process);
    signal("-KILL", child(process.id()).expect("a guard"));
    assert_eq!(process.wait().expect("it ends").code(), Some(2));
    place.nothing_is_left(Duration::from_secs(10));

    let mut process = place.gap("60").spawn().expect("it starts");
    place.wait_for_step(&mut process);
    let guard = child(process.id()).expect("a guard");
    // A diagnosis that stands still cannot clear up behind its guard. A guard that stands still goes on once the diagnosis has ended: the system
    // continues process groups that lose their parent.
    signal("-STOP", process.id());
    signal("-KILL", guard);
    signal("-KILL", process.id());
    process.wait().expect("it ends");
    assert_eq!(listing(&place.temporary()).len(), 1, "its folder");
    place.fmu("abort()").expect("there was a compiler");
    assert_eq!(place.gap("60").output().expect("it runs").status.code(), Some(2));
    place.nothing_is_left(Duration::from_secs(10));
}

#[test]
fn what_an_fmu_begins_does_not_outlive_the_diagnosis() {
    let place = Place::new();
    if place.fmu("if(!fork()){setsid();execl(\"/bin/sleep\",\"sleep\",\"60\",(char*)0);}").is_none() {
        return;
    }
    let output = place.gap("60").output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    place.nothing_is_left(Duration::ZERO);
}

#[test]
fn what_an_fmu_prints_without_end_fills_neither_disk_nor_memory() {
    let place = Place::new();
    for stream in ["1", "2"] {
        let code =
            format!("for(;;){{static char b[1<<16];memset(b,65,sizeof b);write({stream},b,sizeof b);}}");
        if place.fmu(&code).is_none() {
            return;
        }
        let mut process = place.gap("2").spawn().expect("it starts");
        let mut largest = 0;
        while process.try_wait().expect("ours").is_none() {
            largest = largest.max(peak(process.id()).unwrap_or(0));
            let left = listing(&place.temporary());
            assert!(left.len() <= 1, "{left:?}");
            sleep(Duration::from_millis(20));
        }
        let output = process.wait_with_output().expect("it ended");
        let reported = String::from_utf8_lossy(&output.stderr);
        assert!(
            reported.contains("did not return within 2 s") && reported.contains("it said: A"),
            "{reported}"
        );
        assert!(reported.len() < 3000, "{} letters", reported.len());
        assert!(largest > 0 && largest < 64 << 10, "{largest} KiB");
        place.nothing_is_left(Duration::ZERO);
    }
}

#[test]
fn a_file_that_grows_without_end_and_memory_that_does_are_bounded() {
    let place = Place::new();
    let file = "static char b[1<<16];int f=creat(\"big\",0600);while(write(f,b,sizeof b)>0);abort()";
    if place.fmu(file).is_none() {
        return;
    }
    let output = place.gap("60").output().expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("it crashed (signal: 6 (SIGABRT)"));
    place.nothing_is_left(Duration::ZERO);
}

/// The process that has this one as its parent.
fn child(parent: u32) -> Option<u32> {
    let is_child = |id: &u32| {
        let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
        status.lines().any(|line| line == format!("PPid:\t{parent}"))
    };
    let numbers = fs::read_dir("/proc").ok()?.flatten().filter_map(|e| e.file_name().to_str()?.parse().ok());
    numbers.into_iter().find(is_child)
}

/// The most memory that a process had, in KiB.
fn peak(id: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.trim().parse().ok()
}
