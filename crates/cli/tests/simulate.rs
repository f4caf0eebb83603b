//! `switchback simulate`: models that were written run as they did in the command that wrote them.

use crate::common::{Folder, step};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The page of `simulate --json`, and the columns that it wrote.
fn simulated(folder: &Folder, model: &str, input: &str) -> (Value, Vec<[f64; 5]>) {
    let arguments = ["simulate", model, input, "--json", "--out", "run.csv", "--force"];
    let output = folder.switchback(&arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{model} {input}: {}", String::from_utf8_lossy(&output.stderr));
    let page = serde_json::from_slice(&output.stdout).expect("one JSON object on stdout");
    let text = fs::read_to_string(folder.path("run.csv")).expect("a file");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t,v,y,y_low,y_high"));
    let row = |line: &str| -> [f64; 5] {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        cells.try_into().expect("five columns")
    };
    (page, lines.map(row).collect())
}

/// The column of one record in a series.csv.
fn series(folder: &Folder, file: &str, record: &str, column: &str) -> Vec<f64> {
    let text = fs::read_to_string(folder.path(file)).expect("a series");
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let at = header.iter().position(|name| *name == column).expect("the column");
    lines.filter(|row| row[0] == record).filter_map(|row| row[at].parse().ok()).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("a number, not {value}"))
}

fn close(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{what}: {found} is not {expected}");
}

fn run(folder: &Folder, arguments: &[&str]) -> Value {
    let output = folder.switchback(arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object on stdout")
}

/// Exit code 2, nothing on stdout, nothing written, and a message with all the words in it.
fn refused(folder: &Folder, arguments: &[&str], words: &[&str]) {
    let before = folder.listing();
    let output = folder.switchback(arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{reported}");
    assert!(output.stdout.is_empty());
    assert!(reported.contains("help: "), "no remedy: {reported}");
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
    assert_eq!(folder.listing(), before, "nothing may be written");
}

fn with_step_records() -> Folder {
    let folder = Folder::with_good_rig();
    for (name, satellite, role) in [("high", 1.0, "step_high"), ("low", -1.0, "step_low")] {
        folder.write(&format!("{name}.csv"), &step(satellite, 4));
        folder.edit("rig.toml", |text| {
            format!("{text}\n[[record]]\nfile = \"{name}.csv\"\nrole = \"{role}\"\nuse = \"fit\"\n")
        });
    }
    folder
}

#[test]
fn every_method_of_identify_is_reproduced_on_every_record() {
    let folder = with_step_records();
    let methods =
        ["paper-descendant", "paper-ascendant", "joint", "efficient", "free", "linear-arx", "memoryless"];
    for method in methods {
        let page = run(&folder, &["identify", "rig.toml", "--method", method, "--json", "--out", "found"]);
        let fits = page["fit_percent"].as_object().expect("an object");
        let mut seen = 0;
        for (record, fit) in fits {
            let input = format!("{record}.csv");
            if fit.is_null() {
                refused(&folder, &["simulate", "found/model.json", &input], &[&input]);
                continue;
            }
            let (reported, rows) = simulated(&folder, "found/model.json", &input);
            close(number(&reported["fit_percent"]), number(fit), &format!("{method} {record}"));
            let y: Vec<f64> = rows.iter().map(|row| row[2]).collect();
            assert_eq!(y, series(&folder, "found/series.csv", record, "simulated"), "{method} {record}");
            seen += 1;
        }
        assert!(seen >= 2, "{method}: {page:#}");
    }
}

#[test]
fn the_band_of_an_identified_model_holds_the_held_out_record() {
    let folder = Folder::with_good_rig();
    for method in ["efficient", "free"] {
        run(&folder, &["identify", "rig.toml", "--method", method, "--json", "--out", "found"]);
        let (reported, rows) = simulated(&folder, "found/model.json", "again.csv");
        // 1,100 samples, about one in five independent (poles of modulus 0.7): a standard error of 0.015, and three of them.
        let covered = number(&reported["covered"]);
        assert!((covered - 0.95).abs() < 0.045, "{method}: {covered}");
        assert!(rows.iter().all(|row| row[3] <= row[2] && row[2] <= row[4]));
    }
}

/// Fits of `gap` and of `simulate` with the models that it wrote, on every judged record.
fn gap_is_reproduced(folder: &Folder, rig: &str) {
    let page = run(folder, &["gap", rig, "--json", "--out", "report"]);
    let base = Path::new(rig).parent().expect("a folder");
    println!("{rig}: {:#}", page["verdict"]);
    for record in page["gap"]["per_record"].as_array().expect("a list") {
        let name = record["record"].as_str().expect("a name");
        let input = base.join(format!("{name}.csv")).display().to_string();
        for (model, fit) in [("nominal", "fit_before"), ("augmented", "fit_after")] {
            let (reported, rows) = simulated(folder, &format!("report/{model}.json"), &input);
            close(number(&reported["fit_percent"]), number(&record[fit]), &format!("{rig} {name} {model}"));
            let y: Vec<f64> = rows.iter().map(|row| row[2]).collect();
            assert_eq!(y, series(folder, "report/series.csv", name, model), "{rig} {name} {model}");
        }
    }
}

#[test]
fn gap_is_reproduced_on_the_shipped_rig_with_backlash() {
    let rig =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/rigs/leaf-spring-with-backlash/rig.toml");
    gap_is_reproduced(&Folder::with_good_rig(), &rig.display().to_string());
}

#[test]
fn gap_is_reproduced_on_rigs_made_with_effects_that_move_the_simulation() {
    for effect in ["creep", "gain_drift", "sensor_saturation", "resonance", "border_wear", "sensor_drift"] {
        let folder = Folder::with_good_rig();
        let made = folder.switchback(&[
            "rig", "--effect", effect, "--size", "3", "--order", "1", "--seed", "5", "--out", "made",
        ]);
        assert_eq!({ made }.output().expect("it runs").status.code(), Some(0));
        gap_is_reproduced(&folder, "made/rig.toml");
    }
}

#[test]
#[ignore = "reads shared/rigs beside the workspace"]
fn gap_is_reproduced_on_measured_rigs() {
    for name in ["pneumatic-seal", "mr-damper"] {
        let rig =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/rigs").join(name).join("rig.toml");
        gap_is_reproduced(&Folder::with_good_rig(), &rig.display().to_string());
    }
}

#[test]
fn every_model_that_is_written_can_be_diagnosed() {
    let folder = Folder::with_good_rig();
    for method in ["efficient", "free"] {
        run(&folder, &["identify", "rig.toml", "--method", method, "--json", "--out", method]);
        let page = run(&folder, &["gap", "rig.toml", "--model", &format!("{method}/model.json"), "--json"]);
        assert_eq!(page["model"], "given", "{method}");
        assert!(number(&page["gap"]["per_record"][0]["fit_before"]) > 98.0, "{method}: {:#}", page["gap"]);
    }
    let first = run(&folder, &["gap", "rig.toml", "--json", "--out", "report"]);
    for model in ["nominal", "augmented"] {
        let page = run(&folder, &["gap", "rig.toml", "--model", &format!("report/{model}.json"), "--json"]);
        assert_eq!(page["model"], "given");
        let fit = |page: &Value| number(&page["gap"]["per_record"][0]["fit_before"]);
        close(fit(&page), fit(&first), model);
    }
}

#[test]
fn without_a_measured_output_it_begins_at_rest_and_says_so() {
    let folder = Folder::with_good_rig();
    run(&folder, &["identify", "rig.toml", "--json", "--out", "found"]);
    let rows: String = (0..50)
        .map(|k| format!("{:.2},{}\n", 0.01 * f64::from(k), if k < 20 { 1.0 } else { -1.0 }))
        .collect();
    folder.write("input.csv", &format!("t,v\n{rows}"));
    let (page, rows) = simulated(&folder, "found/model.json", "input.csv");
    assert!(page["fit_percent"].is_null() && page["covered"].is_null());
    assert!(page["notes"].to_string().contains("begins at rest"), "{page:#}");
    // It rests on the descending border, which the first move is on: 0.3 − 0.2, a gain of 2.
    assert!(rows[..20].iter().all(|row| (row[2] - rows[0][2]).abs() < 1e-9), "{:?}", rows[0]);
    assert!(
        (rows[0][2] - 0.2).abs() < 0.02 && (rows[49][2] + 1.0).abs() < 0.02,
        "{:?} {:?}",
        rows[0],
        rows[49]
    );
}

/// The columns written for a file, as text.
fn written(folder: &Folder, input: &str, more: &[&str]) -> (Vec<String>, String) {
    let output =
        folder.switchback(&["simulate", "found/model.json", input]).args(more).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{reported}");
    (String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect(), reported)
}

fn with_model() -> Folder {
    let folder = Folder::with_good_rig();
    run(&folder, &["identify", "rig.toml", "--json", "--out", "found"]);
    folder
}

#[test]
fn a_file_of_the_input_alone_is_played_row_by_row() {
    let folder = with_model();
    let column: String = (0..50).map(|k| if k < 20 { "1\n" } else { "-1\n" }).collect();
    folder.write("one.csv", &format!("v\n{column}"));
    let (rows, reported) = written(&folder, "one.csv", &[]);
    assert_eq!(rows.len(), 51);
    assert!(rows[50].starts_with("0.49,-1,"), "{}", rows[50]);
    assert!(reported.contains("begins at rest"), "{reported}");
    folder.write("still.csv", &"1\n".repeat(30));
    let (rows, _) = written(&folder, "still.csv", &[]);
    let outputs: Vec<&str> = rows[1..].iter().filter_map(|row| row.split(',').nth(2)).collect();
    assert!(outputs.iter().all(|row| *row == outputs[0]), "a constant input stays where it rests: {rows:?}");
}

#[test]
fn gaps_in_the_measured_output_are_no_error() {
    let folder = with_model();
    let measured = fs::read_to_string(folder.path("again.csv")).expect("a record");
    let without = |is_missing: &dyn Fn(usize) -> bool| -> String {
        let row = |(k, line): (usize, &str)| match (k > 0 && is_missing(k), line.rsplit_once(',')) {
            (true, Some((input, _))) => format!("{input},NaN\n"),
            _ => format!("{line}\n"),
        };
        measured.lines().enumerate().map(row).collect()
    };
    let reported_of = |text: String| {
        folder.write("gaps.csv", &text);
        simulated(&folder, "found/model.json", "gaps.csv").0
    };
    let (whole, _) = simulated(&folder, "found/model.json", "again.csv");
    let later = reported_of(without(&|k| k % 7 == 0 && k > 50));
    assert_eq!(later["start"], whole["start"]);
    assert!((number(&later["fit_percent"]) - number(&whole["fit_percent"])).abs() < 1.0, "{later:#}");
    assert!(later["notes"].to_string().contains("`y` is missing in"), "{later:#}");
    let at_first = reported_of(without(&|k| k < 5));
    assert_eq!(at_first["start"], 0);
    assert!(at_first["notes"].to_string().contains("begins at rest"), "{at_first:#}");
    let never = reported_of(without(&|_| true));
    assert!(never["fit_percent"].is_null() && never["covered"].is_null(), "{never:#}");
    let (_, reported) = written(&folder, "again.csv", &["--output", "none"]);
    assert!(reported.contains("begins at rest") && !reported.contains("fit"), "{reported}");
}

#[test]
fn time_stamps_are_written_as_they_stood() {
    let folder = with_model();
    let rows: String = (0..40).map(|k| format!("{},{}\n", 10 * k, if k < 20 { 1.0 } else { -1.0 })).collect();
    folder.write("ms.csv", &format!("time [ms],v\n{rows}"));
    let (rows, _) = written(&folder, "ms.csv", &[]);
    assert!(rows[0].starts_with("t [ms],v,") && rows[40].starts_with("390,-1,"), "{} {}", rows[0], rows[40]);
    let rows: String = (0..40)
        .map(|k| format!("2024-03-05T12:00:00.{:02}0,{}\n", k, if k < 20 { 1.0 } else { -1.0 }))
        .collect();
    folder.write("iso.csv", &format!("time,v\n{rows}"));
    let (rows, _) = written(&folder, "iso.csv", &[]);
    assert!(rows[40].starts_with("2024-03-05T12:00:00.390,-1,"), "{}", rows[40]);
}

#[test]
fn an_input_outside_what_was_seen_is_warned_of_and_run() {
    let folder = Folder::with_good_rig();
    run(&folder, &["identify", "rig.toml", "--method", "free", "--json", "--out", "found"]);
    let rows: String = (0..300)
        .map(|k| format!("{:.2},{}\n", 0.01 * f64::from(k), 3.0 * (0.05 * f64::from(k)).sin()))
        .collect();
    folder.write("input.csv", &format!("t,v\n{rows}"));
    let (page, _) = simulated(&folder, "found/model.json", "input.csv");
    let warnings = page["warnings"].to_string();
    assert!(warnings.contains("leaves the range") && warnings.contains("-1 to 1"), "{warnings}");
    assert!(warnings.contains("from one reversal to the next"), "{warnings}");
    let (page, _) = simulated(&folder, "found/model.json", "again.csv");
    assert_eq!(page["warnings"], Value::Array(Vec::new()), "{page:#}");
}

#[test]
fn bad_models_and_inputs_are_refused_with_their_place_and_a_remedy() {
    let folder = Folder::with_good_rig();
    let page = run(&folder, &["identify", "rig.toml", "--json", "--out", "found"]);
    let model = fs::read_to_string(folder.path("found/model.json")).expect("a model");
    let with = |text: &str| folder.write("bad.json", text);
    let refused_model =
        |words: &[&str]| refused(&folder, &["simulate", "bad.json", "again.csv", "--out", "run.csv"], words);
    with("");
    refused_model(&["bad.json:1:1", "empty"]);
    with("{\"schema\": ");
    refused_model(&["no JSON"]);
    with("{\"a\": [1]}");
    refused_model(&["bad.json", "no model", "schema"]);
    with(&page.to_string());
    refused_model(&["model", "identify"]);
    with(&model.replace("switchback/model/1", "switchback/model/9"));
    refused_model(&["switchback/model/9", "switchback/model/1"]);
    with(&model.replace("\"noise_sd\":", "\"noise\":"));
    refused_model(&["bad.json:", "noise"]);
    with(&model.replace("\"kind\": \"points\"", "\"kind\": \"spline\""));
    refused_model(&["spline", "switched, curves, machine or points"]);
    let input = |text: &str| folder.write("bad.csv", text);
    let refused_input = |words: &[&str]| {
        refused(&folder, &["simulate", "found/model.json", "bad.csv", "--out", "run.csv"], words)
    };
    input("t,a,b\n0,1,3\n0.01,2,5\n0.02,1,3\n");
    refused_input(&["bad.csv", "1 `t`, 2 `a`, 3 `b`", "--input NAME --output NAME"]);
    input("t,v\n0,1\n0.01,1\n0.02,NaN\n0.03,1\n0.04,2\n");
    refused_input(&["bad.csv:4", "`v`", "empty or NaN"]);
    input("t,v\n0,1\n0.02,1\n0.04,2\n");
    refused_input(&["0.02 s apart", "0.01 s", "--resample"]);
    input("t,v\n0,1\n0.01,1\n0.02,2\n0.03,2\n0.06,2\n0.07,1\n0.08,1\n");
    refused_input(&["bad.csv:6", "followed by 0.06"]);
    refused(
        &folder,
        &["simulate", "found/model.json", "again.csv", "--out", "rig.toml"],
        &["rig.toml", "there already"],
    );
    refused(&folder, &["simulate", "nowhere.json", "again.csv"], &["nowhere.json"]);
}

#[test]
fn what_does_not_fit_in_a_model_is_named_by_its_keys_and_not_by_types() {
    let folder = Folder::with_good_rig();
    run(&folder, &["gap", "rig.toml", "--json", "--out", "report"]);
    let model: Value =
        serde_json::from_str(&fs::read_to_string(folder.path("report/nominal.json")).expect("a model"))
            .expect("JSON");
    let spoilt = |change: &dyn Fn(&mut Value), words: &[&str]| {
        let mut bad = model.clone();
        change(&mut bad);
        folder.write("bad.json", &bad.to_string());
        refused(&folder, &["simulate", "bad.json", "again.csv"], words);
        let output = folder.switchback(&["simulate", "bad.json", "again.csv"]).output().expect("it runs");
        let reported = String::from_utf8_lossy(&output.stderr).into_owned();
        for word in ["struct", "usize", "isize", "f64", "u64", "variant", "floating point", "no JSON"] {
            assert!(!reported.contains(word), "`{word}` is in: {reported}");
        }
    };
    spoilt(&|m| *m = Value::Null, &["expected an object, found null"]);
    spoilt(&|m| m["model"]["lead"] = 2.5.into(), &["`model.lead`: expected a whole number, found `2.5`"]);
    spoilt(&|m| m["model"]["scales"] = 1.into(), &["`model.scales`: expected an object, found `1`"]);
    spoilt(&|m| m["model"]["criterion"] = true.into(), &["bad.json:", "`model.criterion`"]);
    spoilt(
        &|m| m["model"]["linear"]["a"][0] = "x".into(),
        &["`model.linear.a[0]`: expected a number, found \"x\""],
    );
    refused(
        &folder,
        &["simulate", "report/gap.json", "again.csv"],
        &["this is a diagnosis, but a model is wanted"],
    );
    refused(
        &folder,
        &["compare", "report/gap.json", "report/gap.json"],
        &["this is a diagnosis, not the results of a study"],
    );
    refused(
        &folder,
        &["gap", "rig.toml", "--model", "report/gap.json"],
        &["this is a diagnosis, but a model is wanted"],
    );
}

#[test]
fn a_model_of_other_units_is_refused() {
    let folder = Folder::with_good_rig();
    let measured = fs::read_to_string(folder.path("again.csv")).expect("a record");
    let with = |header: &str| measured.replacen("t,v,y", header, 1);
    folder.write("mm.csv", &with("t,travel [mm],force [N]"));
    folder.write("m.csv", &with("t,travel [m],force [N]"));
    folder.write("kn.csv", &with("t,travel [mm],force [kN]"));
    run(&folder, &["identify", "mm.csv", "--json", "--out", "found"]);
    let input = "the model was identified on travel in mm, this";
    refused(&folder, &["simulate", "found/model.json", "m.csv"], &["m.csv: ", input, "file has m", "to mm"]);
    refused(&folder, &["simulate", "found/model.json", "kn.csv"], &["force in N, this file has kN"]);
    refused(&folder, &["gap", "m.csv", "--model", "found/model.json"], &[input, "rig has m"]);
    simulated(&folder, "found/model.json", "mm.csv");
    simulated(&folder, "found/model.json", "again.csv");
    let (_, reported) = written(&folder, "kn.csv", &["--output", "none"]);
    assert!(reported.contains("begins at rest"), "{reported}");
}
