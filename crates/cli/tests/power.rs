//! `switchback gap --power`: what it finds, writes, and refuses.

use crate::common::{Folder, listing};
use serde_json::Value;
use std::fs;

/// A small rig that takes a moment: without an order to search for.
fn measured(folder: &Folder, more: &[&str]) -> (Value, String) {
    let arguments = [&["gap", "rig.toml", "--power", "--json"], more].concat();
    let output = folder.switchback(&arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{reported}");
    (serde_json::from_slice(&output.stdout).expect("one JSON object on stdout"), reported)
}

fn refused(folder: &Folder, more: &[&str], words: &[&str]) {
    let before = folder.listing();
    let arguments = [&["gap", "rig.toml", "--power", "--out", "report"], more].concat();
    let output = folder.switchback(&arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{reported}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
    assert_eq!(folder.listing(), before, "nothing may be written");
}

#[test]
fn faults_are_put_in_and_counted() {
    let folder = Folder::with_good_rig();
    let plan = ["--effects", "sensor_saturation,record_offset", "--draws", "2", "--out", "report"];
    let (page, reported) = measured(&folder, &plan);
    assert_eq!(page["schema"], "switchback/power/1");
    assert_eq!((&page["rig"], &page["model"]), (&Value::from("small"), &Value::from("identified")));
    assert_eq!(page["power"]["without_fault"]["diagnoses"], 2);
    let effects = page["power"]["effects"].as_array().expect("a list");
    let names: Vec<&Value> = effects.iter().map(|effect| &effect["effect"]).collect();
    assert_eq!(names, ["sensor_saturation", "record_offset"]);
    let mut draws = 0;
    for effect in effects {
        let all = effect["draws"].as_array().expect("a list");
        draws += all.len();
        let diagnosed: Vec<&Value> = all.iter().filter(|draw| draw["found"].is_boolean()).collect();
        assert_eq!(effect["found"]["of"], diagnosed.len(), "{effect:#}");
        let found = diagnosed.iter().filter(|draw| draw["found"] == true).count();
        let count = |key: &str| effect["found"][key].as_u64().expect("a count") as usize;
        assert_eq!(count("named") + count("class"), found, "{effect:#}");
        assert!(diagnosed.iter().all(|draw| draw["size"].as_f64().expect("a size") > 0.25), "{effect:#}");
        let outcome = effect["outcome"].as_str().expect("a name");
        assert!(["from", "not_up_to", "undecided", "not_planted"].contains(&outcome), "{effect:#}");
    }
    assert!((2..=4).contains(&draws), "{draws}");
    // A sensor that clips is plain to see.
    let clipped = effects[0]["found"]["named"].as_u64().expect("a count");
    assert!(clipped >= 1, "{:#}", effects[0]);
    assert!(reported.contains("6 diagnoses at most; the first took"), "{reported}");
    assert_eq!(
        listing(&folder.path("report")),
        [".switchback.sha256", "power.csv", "power.json", "power.svg", "power.txt"]
    );
    let written = fs::read_to_string(folder.path("report/power.json")).expect("it is there");
    assert_eq!(serde_json::from_str::<Value>(&written).expect("JSON"), page);
    let rows = fs::read_to_string(folder.path("report/power.csv")).expect("it is there");
    assert_eq!(rows.lines().count(), 1 + draws);
    let text = fs::read_to_string(folder.path("report/power.txt")).expect("it is there");
    assert!(text.contains("sensor_saturation") && text.contains("Size 1 is a fault"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    // Nothing depends on the number of threads.
    let (again, _) = measured(&folder, &[&plan[..4], &["--threads", "1"]].concat());
    assert_eq!(again, page);
}

#[test]
fn the_model_given_is_the_one_diagnosed() {
    let folder = Folder::with_good_rig();
    let model = folder.switchback(&["identify", "rig.toml", "--json"]).output().expect("it runs");
    folder.write("model.json", &String::from_utf8(model.stdout).expect("text"));
    let plan = ["--model", "model.json", "--effects", "sensor_saturation", "--draws", "1", "--quiet"];
    let (page, reported) = measured(&folder, &plan);
    assert_eq!(page["model"], "given");
    assert_eq!(page["power"]["effects"][0]["draws"].as_array().map(Vec::len), Some(1));
    assert!(reported.is_empty(), "{reported}");
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let folder = Folder::with_good_rig();
    refused(&folder, &["--effects", "blacklash"], &["blacklash", "--effects", "backlash"]);
    refused(&folder, &["--draws", "0"], &["--draws", "give a whole number from 1"]);
    refused(&folder, &["--explain"], &["--explain", "--power"]);
    refused(&folder, &["--model", "none.json"], &["none.json", "no such file"]);
    let without_power = folder.switchback(&["gap", "rig.toml", "--draws", "3"]).output().expect("it runs");
    assert_eq!(without_power.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&without_power.stderr).contains("--power"));
}

#[test]
fn records_that_are_no_context_are_refused() {
    let folder = Folder::with_good_rig();
    for name in ["descendant.csv", "ascendant.csv"] {
        folder.edit(name, |text| text.lines().take(21).map(|line| format!("{line}\n")).collect());
    }
    refused(&folder, &[], &["rig.toml", "samples", "help: "]);
    let folder = Folder::with_good_rig();
    for name in ["descendant.csv", "ascendant.csv", "again.csv"] {
        folder.edit(name, |text| {
            let row = |line: &str| format!("{line},{}\n", line.rsplit(',').next().unwrap_or_default());
            let rows: String = text.lines().skip(1).map(row).collect();
            format!("t,v,y,y_sim\n{rows}")
        });
    }
    refused(&folder, &[], &["rig.toml", "y_sim", "--model", "help: "]);
}
