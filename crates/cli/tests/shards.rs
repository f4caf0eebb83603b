//! Parts of an examination make the report of one run, and nothing else does.

use crate::common::{BLIND, Folder, listing};
use std::fs;

/// Runs, and gives the exit code with what is reported.
fn run(folder: &Folder, arguments: &[&str]) -> (Option<i32>, String) {
    let output = folder.switchback(arguments).output().expect("it runs");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn parts_merged_are_the_bytes_of_one_run() {
    let folder = Folder::with_good_rig();
    let scenario = BLIND.replace("slice = 1", "slice = 2");
    folder.write("two.toml", &scenario);
    assert_eq!(run(&folder, &["two.toml", "--quiet", "--out", "whole"]).0, Some(0));
    for part in ["1", "2"] {
        let shard = format!("{part}/2");
        assert_eq!(run(&folder, &["two.toml", "--shard", &shard, "--quiet", "--out", part]).0, Some(0));
        assert!(!folder.path(part).join("unfinished.jsonl").exists());
    }
    // In any order.
    let merge = ["merge", "2", "1", "--quiet", "--out", "merged"];
    let (code, reported) = run(&folder, &merge);
    assert_eq!(code, Some(0), "{reported}");
    let files = listing(&folder.path("whole"));
    assert_eq!(listing(&folder.path("merged")), files);
    for file in files.into_iter().filter(|name| name != "provenance.json" && !name.contains("beside")) {
        let [one, other] = ["whole", "merged"].map(|f| fs::read(folder.path(f).join(&file)).expect("a file"));
        assert!(one == other, "{file} differs");
    }

    let refused = |arguments: &[&str], words: &[&str]| {
        let (code, reported) = run(&folder, &[arguments, &["--quiet", "--out", "none"]].concat());
        assert_eq!(code, Some(2), "{reported}");
        for word in words {
            assert!(reported.contains(word), "`{word}` is missing in: {reported}");
        }
        assert!(!folder.path("none").exists());
    };
    refused(&["merge", "1"], &["two.toml", "missing: 2/2", "switchback two.toml --shard 2/2"]);
    refused(&["merge", "1", "1", "2"], &["the same part, 1/2"]);
    refused(&["merge", "1", "whole"], &["whole: holds no part"]);
    folder.edit("2/two.toml", |text| text.replace("seed = 4", "seed = 5"));
    refused(&["merge", "1", "2"], &["2: is not as it was written: two.toml has changed"]);
    // What was changed on purpose, with the list of hashes taken away.
    for part in ["1", "2"] {
        fs::remove_file(folder.path(part).join(".switchback.sha256")).expect("a list");
    }
    refused(&["merge", "1", "2"], &["2: part.json is not of the files beside it", "run this part again"]);
    folder.write("2/two.toml", &scenario);
    folder.edit("2/key.jsonl", |text| text.replace("\"seed\":", "\"seed\": "));
    refused(&["merge", "1", "2"], &["2: key.jsonl is not what was judged"]);
    folder.edit("1/part.json", |text| text.replace("\"program\": \"", "\"program\": \"0"));
    refused(&["merge", "1", "2"], &["1: part.json is not of the files beside it"]);
}

#[test]
fn a_part_that_cannot_be_is_refused() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", crate::common::STUDY);
    let (code, reported) = run(&folder, &["study.toml", "--shard", "3/2"]);
    assert_eq!(code, Some(2));
    assert!(reported.contains("as in 1/4"), "{reported}");
}
