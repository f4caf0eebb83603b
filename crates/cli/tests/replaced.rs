//! A report is replaced whole or not at all, whenever the process is killed and whatever the file system can.
#![cfg(all(unix, debug_assertions))]

use crate::common::faults::{BESIDE, Change, RUN, files, killed_at_its_pause, run, start};
use crate::common::{BLIND, Folder, listing};
use std::fs;
use std::time::Instant;

#[test]
fn killed_at_each_call_it_leaves_the_old_report_or_the_new_one() {
    let change = Change::new();
    let (mut olds, mut news) = (0, 0);
    for call in 1.. {
        change.reset();
        if !killed_at_its_pause(start(&change.folder, &RUN, &format!("pause={call}"))) {
            break;
        }
        let now = change.now();
        assert!(now == change.old || now == change.new, "a mixture after a kill at call {call}");
        if now == change.old {
            olds += 1
        } else {
            news += 1
        }
        // What is left differs little from one call to the next.
        if call % 4 == 0 || now == change.new {
            change.ends_well();
        }
    }
    assert!(olds > change.new.len() && news > 0, "{olds} old, {news} new");
}

#[test]
fn killed_at_any_moment_it_leaves_the_old_report_or_the_new_one() {
    let change = Change::new();
    let time = Instant::now();
    assert_eq!(run(&change.folder, &RUN, "").0, Some(0));
    let time = time.elapsed();
    for kill in 0..16 {
        change.reset();
        let mut process = start(&change.folder, &RUN, "");
        std::thread::sleep(time.mul_f64(f64::from(kill) / 15.0));
        process.kill().expect("a process that was not waited for");
        process.wait().expect("it ends");
        let now = change.now();
        assert!(now == change.old || now == change.new, "a mixture after kill {kill}");
    }
    change.ends_well();
}

/// They cannot have a second name in the new folder as files can.
#[test]
fn folders_of_others_come_along_even_if_it_is_killed() {
    let change = Change::new();
    let inside = change.folder.path("out/mine");
    let (mut kept, mut missing) = (0, 0);
    for call in 2 * change.new.len().. {
        change.reset();
        fs::create_dir(&inside).expect("a new folder");
        fs::write(inside.join("x"), "measured").expect("it can be written");
        if !killed_at_its_pause(start(&change.folder, &RUN, &format!("pause={call}"))) {
            break;
        }
        if inside.exists() {
            kept += 1
        } else {
            missing += 1
        }
        assert_eq!(run(&change.folder, &RUN, "").0, Some(0));
        assert_eq!(fs::read_to_string(inside.join("x")).expect("kept"), "measured");
        fs::remove_dir_all(&inside).expect("a folder");
        assert!(change.now() == change.new);
    }
    assert!(kept > 0 && missing == 1, "{kept} kept, {missing} brought back by the next run");
}

/// A shell that works there would find itself in a removed folder.
#[test]
fn the_folder_that_the_process_works_in_stays_itself() {
    use std::os::unix::fs::MetadataExt;
    let change = Change::new();
    let inode = || fs::metadata(change.folder.path("out")).expect("a folder").ino();
    let before = inode();
    let there = |out: &str| {
        let mut command = change.folder.switchback(&["../study.toml", "--quiet", "--out", out]);
        command.current_dir(change.folder.path("out")).assert().success();
    };
    there(".");
    assert_eq!(inode(), before);
    change.ends_well();
    assert_ne!(inode(), before, "elsewhere folders are exchanged");
}

#[test]
fn where_folders_cannot_be_exchanged_a_mixture_is_seen_and_mended() {
    let change = Change::new();
    let (mut mixtures, mut wholes) = (0, 0);
    for call in 1.. {
        change.reset();
        if !killed_at_its_pause(start(&change.folder, &RUN, &format!("no-exchange pause={call}"))) {
            break;
        }
        let now = change.now();
        if now == change.old || now == change.new {
            wholes += 1;
            continue;
        }
        let (code, reported) = run(&change.folder, &["compare", "out", "out", "--quiet"], "");
        assert_eq!(code, Some(2), "a mixture at call {call} is not seen");
        assert!(
            reported.contains("out: is half replaced") && reported.contains("help: run the command"),
            "{reported}"
        );
        mixtures += 1;
        if mixtures % 4 == 1 {
            change.ends_well();
        }
    }
    assert!(mixtures > change.new.len() && wholes > change.new.len(), "{mixtures} mixtures, {wholes} wholes");
}

/// The staging folder of a killed run may be lost, as where a report is copied.
#[test]
fn a_mixture_is_seen_by_its_hashes_alone() {
    let change = Change::new();
    fs::write(change.folder.path("out/table.csv"), &change.new["table.csv"]).expect("it can be written");
    let compare = |name: &str| run(&change.folder, &["compare", name, "out/results.json", "--quiet"], "");
    let (code, reported) = compare("out");
    assert_eq!(code, Some(2), "{reported}");
    assert!(reported.contains("out: is not as it was written: table.csv has changed"), "{reported}");
    fs::remove_file(change.folder.path("out/table.csv")).expect("a file");
    assert!(compare("out").1.contains("table.csv is missing"));
    assert_eq!(compare("out/results.json").0, Some(0), "a file by its name is what the user means");
}

#[test]
fn what_changed_after_a_kill_is_not_overwritten_by_what_is_finished() {
    let change = Change::new();
    let is_mixture = |call: &usize| {
        change.reset();
        assert!(killed_at_its_pause(start(&change.folder, &RUN, &format!("no-exchange pause={call}"))));
        let now = change.now();
        now != change.old && now.contains_key("table.csv") && now["table.csv"] == change.old["table.csv"]
    };
    assert!((1..).any(|call| is_mixture(&call)));
    change.folder.edit("out/table.csv", |text| format!("{text}edited"));
    let edited = change.now();
    let (code, reported) = run(&change.folder, &RUN, "");
    assert_eq!(code, Some(2), "{reported}");
    assert!(
        reported.contains("killed") && reported.contains("table.csv") && reported.contains("--force"),
        "{reported}"
    );
    assert!(change.now() == edited);
    let (code, reported) = run(&change.folder, &[&RUN[..], &["--force"]].concat(), "");
    assert_eq!(code, Some(0), "{reported}");
    change.ends_well();
}

#[test]
fn a_run_that_is_killed_finishes_its_leftovers_even_if_killed_again() {
    let change = Change::new();
    let half = |call: usize| start(&change.folder, &RUN, &format!("no-exchange pause={call}"));
    change.reset();
    // Files are written before they take their places, by two calls each; those that report the run are not counted among the new.
    let writes = 2 * (change.new.len() + BESIDE.len());
    assert!(killed_at_its_pause(half(writes + 4)));
    let first = change.now();
    assert!(first != change.old && first != change.new);
    // Each start goes a little further.
    for _ in 0..3 {
        assert!(killed_at_its_pause(half(2)));
    }
    assert!(change.now() != first);
    change.ends_well();
}

/// The key of an examination changes together with its report.
#[test]
fn a_new_key_never_lies_under_an_old_report() {
    let folder = Folder::with_good_rig();
    let arguments = ["blind.toml", "--quiet", "--out", "out"];
    folder.write("blind.toml", BLIND);
    assert_eq!(run(&folder, &arguments, "").0, Some(0));
    let old = files(&folder.path("out"));
    folder.write("blind.toml", &BLIND.replace("seed = 4", "seed = 5"));
    // Before the first call that changes the report: all is judged, the new keys lie on the disk.
    assert!(killed_at_its_pause(start(&folder, &arguments, "pause=1")));
    let mut now = files(&folder.path("out"));
    let [journal, keys] = ["unfinished.jsonl", "unfinished-key.jsonl"].map(|name| now.remove(name));
    assert!(journal.is_some() && now == old);
    assert_eq!(run(&folder, &arguments, "").0, Some(0));
    let new = files(&folder.path("out"));
    assert_eq!(new["key.jsonl"], keys.expect("sealed keys"));
    assert_ne!(new["key.jsonl"], old["key.jsonl"]);
    assert_eq!(new.keys().collect::<Vec<_>>(), old.keys().collect::<Vec<_>>());
}

/// A mixture of a part's files makes no whole.
#[test]
fn merge_refuses_a_part_that_is_half_replaced() {
    let folder = Folder::with_good_rig();
    let part = ["blind.toml", "--shard", "1/1", "--quiet", "--out", "part"];
    let merge = ["merge", "part", "--quiet", "--out", "whole"];
    folder.write("blind.toml", BLIND);
    assert_eq!(run(&folder, &part, "").0, Some(0));
    let names = listing(&folder.path("part")).len();
    folder.write("blind.toml", &BLIND.replace("seed = 4", "seed = 5"));
    let faults = format!("no-exchange pause={}", 2 * names + 5);
    assert!(killed_at_its_pause(start(&folder, &part, &faults)));
    let (code, reported) = run(&folder, &merge, "");
    assert_eq!(code, Some(2), "{reported}");
    assert!(reported.contains("part: is half replaced"), "{reported}");
    assert!(!folder.path("whole").exists());
    assert_eq!(run(&folder, &part, "").0, Some(0));
    assert_eq!(run(&folder, &merge, "").0, Some(0));
}
