//! Folders that cannot be written are found before the run: another writes there, a file stands at the place, the disk is full.
#![cfg(all(unix, debug_assertions))]

use crate::common::faults::{Change, Files, RUN, run, start};
use crate::common::{Folder, STUDY, listing};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[test]
fn of_two_runs_into_one_folder_the_second_is_refused_at_once() {
    let change = Change::new();
    change.reset();
    let mut first = start(&change.folder, &RUN, "pause=1");
    let mut reported = String::new();
    let mut stderr = BufReader::new(first.stderr.take().expect("piped"));
    stderr.read_line(&mut reported).expect("UTF-8");
    assert_eq!(reported, "paused\n");
    // One that would take minutes.
    change.folder.write("long.toml", &STUDY.replace("replicates = 40", "replicates = 4000000"));
    for arguments in [["long.toml", "--out", "out"], ["long.toml", "--out", "./out/../out"]] {
        let start = Instant::now();
        let (code, reported) = run(&change.folder, &arguments, "");
        assert_eq!(code, Some(2), "{reported}");
        let process = format!("process {} is writing there", first.id());
        assert!(reported.contains(&format!("{}: {process}", arguments[2])), "{reported}");
        assert!(start.elapsed() < Duration::from_secs(10), "it computed first");
    }
    // Another run beside it neither waits nor takes what is not its own.
    let (code, reported) = run(&change.folder, &["rig", "--seed", "7", "--quiet", "--out", "made"], "");
    assert_eq!(code, Some(0), "{reported}");
    assert!(change.folder.listing().contains(&".switchback-out".to_owned()));
    first.kill().expect("it lives");
    first.wait().expect("it ends");
    // And the next clears away what the dead one left, wherever it writes.
    let (code, reported) = run(&change.folder, &["rig", "--seed", "8", "--quiet", "--out", "made"], "");
    assert_eq!(code, Some(0), "{reported}");
    assert!(!change.folder.listing().contains(&".switchback-out".to_owned()));
    assert!(change.now() == change.old);
}

/// Where a file stands at the place, or the folder may not be written to, nothing is computed.
#[test]
fn a_folder_that_cannot_be_written_is_found_before_the_run() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", &STUDY.replace("replicates = 40", "replicates = 4000000"));
    folder.write("file", "mine");
    fs::create_dir(folder.path("sealed")).expect("a new folder");
    let before = folder.listing();
    let refused = |out: &str, words: &str| {
        let (code, reported) = run(&folder, &["study.toml", "--quiet", "--out", out], "");
        assert_eq!(code, Some(2), "{reported}");
        assert!(reported.contains(words) && reported.matches("error: ").count() == 1, "{reported}");
        assert_eq!(folder.listing(), before);
    };
    refused("file", "file is a file");
    refused("file/deep/er", "file is a file");
    refused("/proc/nowhere", "cannot write to this output folder");
    refused("/proc", "cannot write to this output folder");
    // Whoever may write everywhere is refused nowhere.
    fs::set_permissions(folder.path("sealed"), std::os::unix::fs::PermissionsExt::from_mode(0o555))
        .expect("the owner may");
    if fs::write(folder.path("sealed/probe"), "").is_ok() {
        fs::remove_file(folder.path("sealed/probe")).expect("it was written");
        eprintln!("SKIPPED: permissions of folders bind no one here");
        return;
    }
    refused("sealed", "cannot write to this output folder");
    refused("sealed/new", "cannot write to this output folder");
}

/// Mounts a file system of a few pages, or says that it cannot; unmounted when dropped.
struct Small<'f>(&'f Path);

impl<'f> Small<'f> {
    fn mounted(place: &'f Path) -> Option<Self> {
        fs::create_dir(place).expect("a new folder");
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=4m", "none"])
            .arg(place)
            .stderr(Stdio::null())
            .status();
        let is_mounted = mount.is_ok_and(|status| status.success());
        if !is_mounted {
            eprintln!("SKIPPED: a file system is mounted by root only");
        }
        is_mounted.then_some(Self(place))
    }
}

impl Drop for Small<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

#[test]
fn a_full_disk_leaves_the_old_report() {
    let change = Change::new();
    let place = change.folder.path("small");
    let Some(_small) = Small::mounted(&place) else { return };
    // Beside the report, and where the report is the mounted folder itself, which nothing lies beside.
    for out in ["small/out", "small"] {
        let arguments = ["study.toml", "--quiet", "--out", out];
        change.folder.write("study.toml", STUDY);
        let (code, reported) = run(&change.folder, &arguments, "");
        assert_eq!(code, Some(0), "{reported}");
        let old = files_and_folders(&change.folder.path(out));
        change.folder.write("study.toml", &STUDY.replace("seed = 3", "seed = 4"));
        // Without a byte to spare, and with a part of what is needed.
        for spare in [0, 16 << 10] {
            let (ballast, mut size) = (place.join("ballast"), 4 << 20);
            while fs::write(&ballast, vec![1; size]).is_err() {
                size -= 4 << 10;
            }
            fs::write(&ballast, vec![1; size - spare]).expect("less than before");
            let (code, reported) = run(&change.folder, &arguments, "");
            assert_eq!(code, Some(2), "{reported}");
            assert!(
                reported.contains("No space left") && reported.matches("error: ").count() == 1,
                "{reported}"
            );
            fs::remove_file(&ballast).expect("it is there");
            assert!(files_and_folders(&change.folder.path(out)) == old);
            let names = listing(&place);
            assert!(names.iter().all(|name| !name.starts_with(".switchback-")), "{names:?}");
        }
        let (code, reported) = run(&change.folder, &arguments, "");
        assert_eq!(code, Some(0), "{reported}");
        assert!(files_and_folders(&change.folder.path(out)) != old);
        assert!(!change.folder.listing().contains(&".switchback-small".to_owned()));
        let _ = fs::remove_dir_all(place.join("out"));
    }
}

/// As [`files`], folders without contents.
fn files_and_folders(folder: &Path) -> Files {
    let read = |name: String| (name.clone(), fs::read(folder.join(name)).unwrap_or_default());
    listing(folder).into_iter().map(read).collect()
}
