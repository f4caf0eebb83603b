//! `switchback train`

use crate::common::Folder;
use std::fs;

fn refused(folder: &Folder, words: &[&str]) -> String {
    let output = folder.switchback(&[&["train"], words].concat()).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{words:?}: {said}");
    said
}

/// Rigs are drawn by their number: parts are the rows of the whole, on any number of threads, and a small posterior decides.
#[test]
fn parts_of_a_table_are_its_rows_and_what_is_trained_on_them_decides() {
    let folder = Folder::with_good_rig();
    let drawn = |words: &[&str], out: &str| {
        let all = [&["train", "--draw", "7", "--seed", "3", "--out", out, "--quiet"], words].concat();
        let output = folder.switchback(&all).output().expect("it runs");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(folder.path(out)).expect("a table")
    };
    // As if another part were being drawn into the folder.
    fs::create_dir_all(folder.path("parts/.switchback-4.csv")).expect("a folder");
    let parts: Vec<String> = (1..=3)
        .map(|k| drawn(&["--shard", &format!("{k}/3"), "--threads", "2"], &format!("parts/{k}.csv")))
        .collect();
    let whole = drawn(&["--threads", "1"], "whole.csv");
    let rows = |text: &str| text.lines().skip(1).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(rows(&whole), parts.iter().flat_map(|part| rows(part)).collect::<Vec<_>>());
    let train = ["train", "parts", "--out", "small.bin"];
    let output = folder.switchback(&train).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    for expected in ["in 3 tables; held out by base and law", "all, model given", "named from "] {
        assert!(said.contains(expected), "{expected} in\n{said}");
    }
    let other = folder.switchback(&["train", "whole.csv", "--out", "whole.bin", "--quiet"]);
    assert_eq!({ other }.output().expect("it runs").status.code(), Some(0));
    let bytes = |name: &str| fs::read(folder.path(name)).expect("a posterior");
    // But for their provenance both are the same.
    assert_eq!(bytes("small.bin").len(), bytes("whole.bin").len());
}

#[test]
fn what_is_no_table_is_refused() {
    let folder = Folder::with_good_rig();
    fs::create_dir(folder.path("empty")).expect("a folder");
    folder.write(
        "few.csv",
        "label,weight,family,law,base,size,kind,given,also,x\nnone,1,wide,,wide,0,nothing,no,,1\n",
    );
    folder.write(
        "other.csv",
        "label,weight,family,law,base,size,kind,given,also,z\nnone,1,wide,,wide,0,nothing,no,,1\n",
    );
    assert!(refused(&folder, &["empty", "--out", "p.bin"]).contains("holds no table"));
    assert!(refused(&folder, &["rig.toml", "--out", "p.bin"]).contains("rig.toml"));
    assert!(refused(&folder, &["few.csv", "--out", "p.bin"]).contains("teaches nothing"));
    assert!(
        refused(&folder, &["few.csv", "other.csv", "--out", "p.bin"]).contains("other columns than few.csv")
    );
    assert!(refused(&folder, &["missing.csv", "--out", "p.bin"]).contains("missing.csv"));
    assert!(refused(&folder, &["few.csv", "--out", "rig.toml"]).contains("--force"));
    assert!(refused(&folder, &["--out", "p.bin"]).contains("--draw"));
    let none = ["--draw", "2", "--measured", "empty", "--out", "t.csv"];
    assert!(refused(&folder, &none).contains("holds no measured rig"));
    let gap = folder.switchback(&["gap", "rig.toml", "--posterior", "few.csv"]).output().expect("it runs");
    assert_eq!(gap.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&gap.stderr).contains("few.csv"));
}
