//! `switchback calibrate`

use crate::common::Folder;
use serde_json::Value;
use std::fs;
use std::process::Output;

fn calibrated(folder: &Folder, words: &[&str]) -> Output {
    let from = folder.judged_slice();
    folder.switchback(&[&["calibrate", from], words].concat()).output().expect("it runs")
}

/// The committed examination is small: what is fitted to it is a check of the command, and no verdict of use.
#[test]
fn what_is_fitted_to_the_committed_examination_stays_the_same() {
    let folder = Folder::with_good_rig();
    let output = calibrated(&folder, &["--out", "verdict.json", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value =
        serde_json::from_str(&fs::read_to_string(folder.path("verdict.json")).expect("a file"))
            .expect("JSON");
    let kept: Value = serde_json::from_str(include_str!("calibrate/field-slice.json")).expect("JSON");
    assert_eq!(found["provenance"], kept["provenance"]);
    assert_eq!((&found["shares"], &found["agreed"]), (&kept["shares"], &kept["agreed"]));
    for part in ["effect", "none", "none_of_these"] {
        let (found, kept) = (found[part].as_array().expect("a list"), kept[part].as_array().expect("a list"));
        assert_eq!(found.len(), kept.len());
        for (found, kept) in found.iter().zip(kept) {
            assert_eq!((&found["feature"], &found["met"]), (&kept["feature"], &kept["met"]));
            let [value, expected] = [found, kept].map(|c| c["value"].as_f64().expect("a number"));
            // Sums in another order on other processors.
            assert!((value - expected).abs() < 1e-4, "{found} {kept}");
        }
    }
}

#[test]
fn the_rules_and_the_fitted_verdict_are_reported_side_by_side() {
    let output = calibrated(&Folder::with_good_rig(), &[]);
    let words = String::from_utf8(output.stdout).expect("text");
    for expected in [
        "log-loss",
        "by rules\n",
        "by the fitted verdict alone, out of fold\n",
        "as the program shows it, out of fold (of ",
        " likely causes on which all readings agree ",
        "calibration error",
    ] {
        assert!(words.contains(expected), "{expected} in\n{words}");
    }
}

#[test]
fn folders_that_hold_no_judged_rigs_are_refused() {
    let folder = Folder::with_good_rig();
    let output = folder.switchback(&["calibrate", "."]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(words.contains("holds no judged rigs of a field examination"), "{words}");
    let twice = calibrated(&folder, &["field-slice"]);
    assert_eq!(twice.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&twice.stderr).contains("`field-slice` is among the folders already"));
    // Nothing is written over.
    let kept = folder.switchback(&["calibrate", ".", "--out", "rig.toml"]).output().expect("it runs");
    assert_eq!(kept.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&kept.stderr).contains("--force"));
}
