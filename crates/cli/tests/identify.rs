//! `switchback identify` on good rigs.

use crate::common::{Folder, listing};
use serde_json::Value;
use std::fs;

fn identified(folder: &Folder, more: &[&str]) -> Value {
    let arguments = [&["identify", "rig.toml", "--json"], more].concat();
    let output = folder.switchback(&arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object on stdout")
}

fn near(value: &Value, truth: f64, tolerance: f64) {
    let value = value.as_f64().expect("a number");
    assert!((value - truth).abs() <= tolerance, "{value} is not {truth} ± {tolerance}");
}

/// The sentence of a flag.
fn flag(found: &Value, kind: &str) -> String {
    let flags = found["flags"].as_array().expect("a list");
    let flag =
        flags.iter().find(|flag| flag["kind"] == kind).unwrap_or_else(|| panic!("{kind} in {flags:?}"));
    flag["text"].as_str().expect("a sentence").to_owned()
}

#[test]
fn every_pulse_method_finds_the_system_of_the_small_rig() {
    let folder = Folder::with_good_rig();
    for method in ["efficient", "joint"] {
        let found = identified(&folder, &["--method", method]);
        assert_eq!(found["schema"], "switchback/identify/1");
        assert_eq!(found["method"], method);
        assert_eq!(found["order"], 2);
        for (letter, truth) in [("a", [-1.2, 0.5]), ("b", [0.4, 0.2])] {
            for i in 0..2 {
                near(&found[letter][i], truth[i], 0.01);
                assert!(found[format!("{letter}_se")][i].as_f64().expect("a number") > 0.0);
            }
        }
        near(&found["gain"], 2.0, 0.02);
        near(&found["y_high"], 1.0, 0.02);
        near(&found["y_low"], -1.0, 0.02);
        assert_eq!(found["descendant"].as_array().map(Vec::len), Some(4));
        near(&found["descendant"][0]["v"], -1.0, 0.0);
        near(&found["descendant"][0]["f"], -0.5, 0.01);
        near(&found["ascendant"][3]["f"], 0.5, 0.01);
        assert!(found["excitation"].as_f64().expect("a number") > 0.0);
        assert!(found["fit_percent"]["again"].as_f64().expect("a number") > 98.0);
    }
}

#[test]
fn the_papers_method_takes_the_level_from_the_step_experiment() {
    for (name, satellite, role, border, other) in [
        ("descendant", 1.0, "step_high", "descendant", "ascendant"),
        ("ascendant", -1.0, "step_low", "ascendant", "descendant"),
    ] {
        let folder = Folder::with_good_rig();
        folder.write("step.csv", &crate::common::step(satellite, 4));
        folder.edit("rig.toml", |text| {
            format!("{text}\n[[record]]\nfile = \"step.csv\"\nrole = \"{role}\"\nuse = \"fit\"\n")
        });
        let found = identified(&folder, &["--method", &format!("paper-{name}"), "--out", "report"]);
        near(&found["a"][0], -1.2, 0.01);
        near(&found["y_high"], 1.0, 0.02);
        near(&found["y_low"], -1.0, 0.02);
        let points = found[border].as_array().expect("a list");
        assert_eq!(points.len(), 4);
        for point in points {
            let v = point["v"].as_f64().expect("a number");
            near(&point["f"], 0.3 * v - 0.2 * satellite, 0.01);
        }
        // The other border was not seen, so records that run on it have no fit and no figure.
        assert_eq!(found[other], Value::Array(Vec::new()));
        assert!(found["fit_percent"][name].as_f64().expect("a number") > 98.0);
        assert!(found["fit_percent"][other].is_null());
        assert!(!folder.path(&format!("report/measured_and_simulated_{other}.svg")).exists());
        assert!(flag(&found, "one_border").contains("border only"));
    }
}

#[test]
fn without_a_method_the_best_one_is_taken() {
    let folder = Folder::with_good_rig();
    assert_eq!(identified(&folder, &[])["method"], "efficient");
}

#[test]
fn the_page_for_a_person_marks_the_hold_out() {
    let folder = Folder::with_good_rig();
    let output = folder.switchback(&["identify", "rig.toml"]).output().expect("it runs");
    let page = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(page.contains("small: efficient, order 2"), "{page}");
    assert!(page.contains("95 % interval") && page.contains("hold-out"), "{page}");
    assert!(page.lines().all(|line| line == line.trim_end()), "no blanks at the ends of lines");
}

#[test]
fn the_output_folder_holds_the_estimate_and_the_figures() {
    let folder = Folder::with_good_rig();
    let printed = identified(&folder, &["--out", "deep/report"]);
    assert_eq!(
        listing(&folder.path("deep/report")),
        [
            ".switchback.sha256",
            "borders.svg",
            "estimate.json",
            "index.html",
            "measured_and_simulated_again.svg",
            "measured_and_simulated_ascendant.svg",
            "measured_and_simulated_descendant.svg",
            "model.json",
            "series.csv",
        ]
    );
    let written = fs::read(folder.path("deep/report/estimate.json")).expect("estimate.json");
    assert_eq!(serde_json::from_slice::<Value>(&written).expect("JSON"), printed);
}

#[test]
fn two_runs_write_the_same_bytes() {
    let folder = Folder::with_good_rig();
    identified(&folder, &["--out", "one"]);
    identified(&folder, &["--out", "two"]);
    for name in listing(&folder.path("one")) {
        let read = |side: &str| fs::read(folder.path(side).join(&name)).expect("a file");
        assert_eq!(read("one"), read("two"), "{name}");
    }
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_are_read() {
    let folder = Folder::with_good_rig();
    let plain = identified(&folder, &[]);
    for name in ["rig.toml", "descendant.csv", "ascendant.csv", "again.csv"] {
        folder.edit(name, |text| format!("\u{feff}{}", text.replace('\n', "\r\n")));
    }
    assert_eq!(identified(&folder, &[]), plain);
}

#[test]
fn columns_are_found_by_name_in_any_order_beside_others() {
    let folder = Folder::with_good_rig();
    let plain = identified(&folder, &[]);
    folder.edit("descendant.csv", |text| {
        let rows = text.lines().map(|row| {
            let cells: Vec<&str> = row.split(',').collect();
            format!("{}, note, {},{}\n", cells[2], cells[0], cells[1])
        });
        rows.collect()
    });
    assert_eq!(identified(&folder, &[]), plain);
}

#[test]
fn records_of_the_same_name_in_different_folders_are_distinguished() {
    let folder = Folder::with_good_rig();
    for sub in ["one", "two"] {
        fs::create_dir(folder.path(sub)).expect("writable");
        fs::copy(folder.path("again.csv"), folder.path(sub).join("again.csv")).expect("writable");
    }
    let more =
        |file: &str| format!("[[record]]\nfile = \"{file}\"\nrole = \"descendant\"\nuse = \"holdout\"\n");
    folder.edit("rig.toml", |text| format!("{text}\n{}{}", more("one/again.csv"), more("two/again.csv")));
    let fits = identified(&folder, &["--out", "report"])["fit_percent"].clone();
    let names: Vec<&String> = fits.as_object().expect("an object").keys().collect();
    assert_eq!(names, ["again", "ascendant", "descendant", "one-again", "two-again"]);
}

#[test]
fn the_order_is_chosen_from_the_data_where_it_is_not_given() {
    let folder = Folder::with_good_rig();
    folder.replace_line("rig.toml", 3, "");
    let found = identified(&folder, &[]);
    assert_eq!(found["order"], 2);
    assert!(flag(&found, "order_chosen").contains("order 2 was chosen"));
}

#[test]
fn a_method_without_its_experiment_says_which_it_needs() {
    let folder = Folder::with_good_rig();
    let output = folder
        .switchback(&["identify", "rig.toml", "--method", "paper-descendant"])
        .output()
        .expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr.contains("needs a `step_high` record") && stderr.contains("help: "), "{stderr}");
}

#[test]
fn an_unknown_method_lists_the_known_ones() {
    let folder = Folder::with_good_rig();
    let output =
        folder.switchback(&["identify", "rig.toml", "--method", "kalman"]).output().expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr.contains("paper-descendant") && stderr.contains("memoryless"), "{stderr}");
}

/// The small rig with its pulse records declared free, so that only what any record shows is used.
fn undesigned() -> Folder {
    let folder = Folder::with_good_rig();
    folder.edit("rig.toml", |text| {
        text.replace("\"descendant\"", "\"free\"").replace("\"ascendant\"", "\"free\"")
    });
    folder
}

#[test]
fn records_that_nobody_designed_go_to_the_free_method() {
    let found = identified(&undesigned(), &[]);
    assert_eq!(found["method"], "free");
    assert!(found["fit_percent"]["again"].as_f64().expect("a number") > 98.0, "{found}");
}

#[test]
fn the_baselines_run_and_show_one_static_curve() {
    let folder = undesigned();
    for method in ["linear-arx", "memoryless"] {
        let found = identified(&folder, &["--method", method, "--out", method]);
        assert_eq!(found["method"], method);
        assert_eq!(found["descendant"], found["ascendant"]);
        assert!(listing(&folder.path(method)).contains(&"borders.svg".to_owned()));
    }
}

/// Measured records are their authors' work and lie beside the workspace, not in it.
fn measured(rig: &str) -> Option<std::path::PathBuf> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/rigs")
        .join(rig)
        .join("rig.toml");
    if !path.exists() {
        println!("skipped: {} is not there; the README names the records' public source", path.display());
    }
    path.exists().then_some(path)
}

#[test]
fn a_measured_rig_is_read_identified_and_judged_on_its_hold_out() {
    let Some(path) = measured("mr-damper") else { return };
    let folder = Folder::with_good_rig();
    let rig = path.to_str().expect("a UTF-8 path");
    let output = folder.switchback(&["identify", rig, "--json"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(found["method"], "free");
    assert_eq!(found["records"][1]["use"], "holdout");
    // A switch with eleven points a border, fitted by equation errors at n = 1, reaches 62 % here.
    assert!(
        found["fit_percent"]["sweep_down"].as_f64().expect("a number") > 62.0,
        "{}",
        found["fit_percent"]
    );
}
