//! `switchback gap`: what it writes, and what it does with bad input.

use crate::common::{Folder, listing};
use serde_json::Value;
use std::fs;
use switchback_diagnose::Effect;
use switchback_io::rig::{ColumnNames, Request};

fn diagnosed(folder: &Folder, more: &[&str]) -> Value {
    let arguments = [&["gap", "rig.toml", "--json"], more].concat();
    let output = folder.switchback(&arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object on stdout")
}

/// Exit code 2, nothing on stdout, nothing written, and a message with all the words in it.
fn refused(folder: &Folder, more: &[&str], words: &[&str]) {
    let before = folder.listing();
    let arguments = [&["gap", "rig.toml", "--out", "report"], more].concat();
    let output = folder.switchback(&arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{reported}");
    assert!(output.stdout.is_empty());
    assert!(reported.contains("help: "), "no remedy: {reported}");
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
    assert_eq!(folder.listing(), before, "nothing may be written");
}

fn limitations(page: &Value) -> String {
    page["limitations"].to_string()
}

/// Keeps the first `rows` rows of a record.
fn shorten(folder: &Folder, name: &str, rows: usize) {
    folder.edit(name, |text| text.lines().take(rows + 1).map(|line| format!("{line}\n")).collect());
}

/// Rewrites the rows of a record, given as `[t, v, y]`.
fn rewrite(folder: &Folder, name: &str, header: &str, row: impl Fn([f64; 3]) -> String) {
    folder.edit(name, |text| {
        let mut rewritten = format!("{header}\n");
        for line in text.lines().skip(1) {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
            rewritten.push_str(&row([cells[0], cells[1], cells[2]]));
            rewritten.push('\n');
        }
        rewritten
    });
}

fn model_of(folder: &Folder) -> Value {
    let output = folder.switchback(&["identify", "rig.toml", "--json"]).output().expect("it runs");
    serde_json::from_slice(&output.stdout).expect("a model")
}

fn refused_model(change: impl Fn(&mut Value), words: &[&str]) {
    let folder = Folder::with_good_rig();
    let mut model = model_of(&folder);
    change(&mut model);
    folder.write("model.json", &model.to_string());
    refused(&folder, &["--model", "model.json"], words);
}

#[test]
fn a_rig_without_a_gap_has_none() {
    let folder = Folder::with_good_rig();
    let page = diagnosed(&folder, &[]);
    assert_eq!(page["verdict"]["status"], "none", "{page:#}");
    assert_eq!(page["model"], "identified");
    assert_eq!(page["verdict"]["effects"], Value::Array(Vec::new()));
    assert!(page["gap"]["closure"].is_null());
    assert!(page["next_experiment"].is_null());
    for field in ["estimate", "ci90"] {
        assert!(!page["gap"]["before"][field].is_null(), "{field}");
    }
    assert_eq!(page["schema"], "switchback/gap/1");
    let candidate = &page["candidates"][0];
    let fields =
        ["effect", "stage", "probability", "parameters", "bic", "delta_bic", "heldout_log_score", "closure"];
    for field in fields {
        assert!(candidate.get(field).is_some(), "{field}");
    }
    let number = |x: &Value| x.as_f64().expect("a number");
    // The criterion's value less its drop's sign: every candidate is held against the same nominal model.
    let nominal: Vec<f64> = page["candidates"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|c| number(&c["bic"]) + number(&c["delta_bic"]))
        .collect();
    assert!(nominal.iter().all(|bic| (bic - nominal[0]).abs() < 1e-6 * nominal[0].abs()), "{nominal:?}");
    assert!(page["candidates"].as_array().is_some_and(|all| all.iter().all(|c| c["unstable"].is_boolean())));
}

#[test]
fn a_cell_shows_its_ends_its_share_and_its_exposure() {
    let folder = Folder::with_good_rig();
    let page = diagnosed(&folder, &[]);
    let cells = page["where"].as_array().expect("a list");
    let of = |axis: &str| cells.iter().filter(|c| c["axis"] == axis).collect::<Vec<_>>();
    let number = |x: &Value| x.as_f64().expect("a number");
    for cell in cells {
        let [share, exposure, enrichment] = ["share", "exposure", "enrichment"].map(|key| number(&cell[key]));
        assert!(exposure > 0.0 && (enrichment * exposure - share).abs() < 1e-9, "{cell:#}");
        assert!(cell["q_value"].is_number() && cell["enrichment_q_value"].is_number(), "{cell:#}");
    }
    for kind in of("branch").into_iter().chain(of("record")) {
        assert!(["low", "high", "unit"].iter().all(|key| kind[*key].is_null()), "{kind:#}");
    }
    for (axis, unit) in
        [("v", "input units"), ("speed", "input units/s"), ("frequency", "Hz"), ("rest_samples", "samples")]
    {
        let all = of(axis);
        assert!(!all.is_empty() && all.iter().all(|c| c["unit"] == unit), "{axis}: {all:#?}");
        assert!(
            all.iter()
                .all(|c| c["low"].is_number()
                    && c["low"].as_f64() < c["high"].as_f64().or(Some(f64::INFINITY)))
        );
    }
    let whole: f64 = of("branch").iter().map(|c| number(&c["exposure"])).sum();
    assert!((whole - 1.0).abs() < 0.02, "{whole}");
}

#[test]
fn what_the_rig_is_known_not_to_have_is_no_candidate() {
    let folder = Folder::with_good_rig();
    let page = diagnosed(&folder, &["--without", "creep", "--without", "backlash"]);
    let names: Vec<&Value> =
        page["candidates"].as_array().expect("a list").iter().map(|c| &c["effect"]).collect();
    assert!(names.len() > 5 && names.iter().all(|name| *name != "creep" && *name != "backlash"), "{names:?}");
    assert!(limitations(&page).contains("left out of the candidates, as asked: backlash, creep"), "{page:#}");
    let unknown = folder.switchback(&["gap", "rig.toml", "--without", "friction"]).output().expect("it runs");
    let reported = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert_eq!(unknown.status.code(), Some(2), "{reported}");
    assert!(["friction", "--without", "stribeck"].iter().all(|word| reported.contains(word)), "{reported}");
}

#[test]
fn a_rig_is_judged_without_any_candidate() {
    let folder = Folder::with_good_rig();
    let all: Vec<&str> = Effect::ALL.iter().flat_map(|e| ["--without", e.name()]).collect();
    assert_eq!(diagnosed(&folder, &all)["verdict"]["status"], "none");
}

#[test]
fn the_report_folder_holds_the_object_and_the_figures() {
    let folder = Folder::with_good_rig();
    let page = diagnosed(&folder, &["--out", "report"]);
    let expected = [
        ".switchback.sha256",
        "augmented.json",
        "candidates.svg",
        "gap.json",
        "index.html",
        "nominal.json",
        "outputs_again.svg",
        "residuals.svg",
        "series.csv",
        "verdict.txt",
        "where.svg",
    ];
    assert_eq!(listing(&folder.path("report")), expected);
    let written = fs::read_to_string(folder.path("report/gap.json")).expect("it is there");
    assert_eq!(serde_json::from_str::<Value>(&written).expect("JSON"), page);
}

#[test]
fn a_log_for_viewers_holds_what_the_series_do() {
    let folder = Folder::with_good_rig();
    let run = |words: &[&str]| folder.switchback(words).output().expect("it runs");
    let output = run(&["gap", "rig.toml", "--out", "report", "--mcap", "--quiet"]);
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    if !switchback_io::model::WRITES_LOGS {
        assert_eq!(output.status.code(), Some(2), "{reported}");
        assert!(reported.contains("--features mcap") && !folder.path("report").exists(), "{reported}");
        return;
    }
    assert_eq!(output.status.code(), Some(0), "{reported}");
    let text = fs::read_to_string(folder.path("report/series.csv")).expect("it is there");
    let rows = text.lines().skip(1).filter(|line| line.starts_with("again,"));
    let cell = |line: &str, k: usize| line.split(',').nth(k).and_then(|cell| cell.parse().ok());
    for (name, column) in [("measured", 4), ("nominal", 5)] {
        let wanted: Vec<[f64; 2]> =
            rows.clone().map(|line| [cell(line, 3).expect("v"), cell(line, column).expect("y")]).collect();
        let named = |name: &str| Some(format!("/again.{name}"));
        let request = Request {
            data: vec![folder.path("report/series.mcap")],
            columns: ColumnNames { time: None, input: named("input"), output: named(name) },
            ..Request::default()
        };
        let rig = request.load("gap").unwrap_or_else(|error| panic!("{error:?}")).rig;
        let read: Vec<[f64; 2]> = rig
            .records
            .iter()
            .flat_map(|r| r.record.v().iter().zip(r.record.y()).map(|(v, y)| [*v, *y]).collect::<Vec<_>>())
            .collect();
        assert_eq!(read.len(), wanted.len(), "{name}");
        let near =
            |(read, wanted): (&[f64; 2], &[f64; 2])| (0..2).all(|k| (read[k] - wanted[k]).abs() < 1e-9);
        assert!(read.iter().zip(&wanted).all(near), "{name}");
    }
    assert_eq!(run(&["report", "report", "--quiet"]).status.code(), Some(0), "the page can be drawn again");
}

#[test]
fn the_words_say_the_verdict_and_the_fit_of_the_held_out_record() {
    let folder = Folder::with_good_rig();
    let output = folder.switchback(&["gap", "rig.toml"]).output().expect("it runs");
    let reported = String::from_utf8(output.stdout).expect("text");
    assert!(reported.contains("Nothing significant is missing from the model"), "{reported}");
    assert!(reported.lines().any(|line| line.starts_with("again ")), "{reported}");
    assert!(reported.lines().all(|line| line.chars().count() <= 100), "{reported}");
}

#[test]
fn a_given_model_is_the_one_diagnosed() {
    let folder = Folder::with_good_rig();
    folder.write("model.json", &model_of(&folder).to_string());
    let page = diagnosed(&folder, &["--model", "model.json"]);
    assert_eq!(page["model"], "given");
    assert!(page["gap"]["per_record"][0]["fit_before"].as_f64().expect("a number") > 98.0, "{page:#}");
}

#[test]
fn a_given_model_of_another_gain_lacks_nothing_but_that() {
    let folder = Folder::with_good_rig();
    let mut model = model_of(&folder);
    let louder = |x: &Value| Value::from(1.2 * x.as_f64().expect("a number"));
    let b: Vec<Value> = model["b"].as_array().expect("coefficients").iter().map(louder).collect();
    let gain = louder(&model["gain"]);
    (model["b"], model["gain"]) = (b.into(), gain);
    folder.write("model.json", &model.to_string());
    let page = diagnosed(&folder, &["--model", "model.json"]);
    assert_eq!(page["verdict"]["status"], "parameters");
    assert_eq!(page["verdict"]["effects"].as_array().map(Vec::len), Some(0));
    let differences = page["differences"].as_array().expect("a list");
    let off: Vec<&Value> = differences.iter().filter(|row| row["differs"] == true).collect();
    let [gain] = off[..] else { panic!("{off:#?}") };
    assert_eq!(
        (&gain["what"], &gain["kind"], &gain["effect"]),
        (&"gain".into(), &"parameter".into(), &Value::Null)
    );
    assert!((gain["in_b"].as_f64().expect("a number") * 1.2 - 1.0).abs() < 0.01, "{gain:#}");
    assert_eq!(page["verdict"]["calibrated"], false);
    let figure = |key: &str| page["gap"][key]["estimate"].as_f64().expect("a number");
    assert!(figure("before") > 0.01 && figure("closure") > 0.99, "{page:#}");
    assert!(figure("identified_anew").abs() < 1e-3 * figure("before"), "{page:#}");
    let output = folder.switchback(&["gap", "rig.toml", "--model", "model.json"]).output().expect("it runs");
    let reported = String::from_utf8(output.stdout).expect("text").replace('\n', " ");
    assert!(reported.contains("What differs: the machine's gain is 0.83"), "{reported}");
}

#[test]
fn another_simulators_predictions_are_diagnosed_in_their_column() {
    let folder = Folder::with_good_rig();
    for name in ["descendant.csv", "ascendant.csv", "again.csv"] {
        rewrite(&folder, name, "t,v,y,y_sim", |[t, v, y]| format!("{t},{v},{y},{}", 0.9 * y + 0.05));
    }
    let page = diagnosed(&folder, &[]);
    assert_eq!(page["model"], "y_sim");
    let fit = page["gap"]["per_record"][0]["fit_before"].as_f64().expect("a number");
    assert!((70.0..95.0).contains(&fit), "{fit}");
}

#[test]
fn predictions_with_gaps_are_refused() {
    let folder = Folder::with_good_rig();
    rewrite(&folder, "again.csv", "t,v,y,y_sim", |[t, v, y]| format!("{t},{v},{y},{y}"));
    folder.replace_line("again.csv", 5, "0.03,1,1.0,");
    refused(&folder, &[], &["again.csv:5", "y_sim", "empty"]);
}

#[test]
fn predictions_for_the_wrong_records_are_refused() {
    let folder = Folder::with_good_rig();
    rewrite(&folder, "ascendant.csv", "t,v,y,y_sim", |[t, v, y]| format!("{t},{v},{y},{y}"));
    refused(&folder, &[], &["again", "ascendant", "y_sim", "holdout"]);
}

#[test]
fn without_a_hold_out_the_diagnosis_says_what_its_figures_are_worth() {
    let folder = Folder::with_good_rig();
    folder.edit("rig.toml", |text| text.replace("holdout", "fit"));
    let page = diagnosed(&folder, &[]);
    assert!(limitations(&page).contains("no held-out record can be judged"), "{page:#}");
    let output = folder.switchback(&["gap", "rig.toml"]).output().expect("it runs");
    assert!(String::from_utf8_lossy(&output.stdout).contains("none is held out"));
}

#[test]
fn records_too_short_for_their_order_are_refused() {
    let folder = Folder::with_good_rig();
    shorten(&folder, "descendant.csv", 5);
    refused(&folder, &[], &["descendant.csv", "5 samples"]);
    let folder = Folder::with_good_rig();
    shorten(&folder, "descendant.csv", 20);
    shorten(&folder, "ascendant.csv", 20);
    refused(&folder, &[], &["rig.toml", "samples", "order"]);
}

#[test]
fn an_input_that_never_moves_is_refused() {
    let folder = Folder::with_good_rig();
    for name in ["descendant.csv", "ascendant.csv"] {
        rewrite(&folder, name, "t,v,y", |[t, _, y]| format!("{t},1,{y}"));
    }
    refused(&folder, &[], &["rig.toml", "never moves"]);
}

#[test]
fn a_hold_out_that_never_moves_is_no_hold_out() {
    let folder = Folder::with_good_rig();
    rewrite(&folder, "again.csv", "t,v,y", |[t, _, y]| format!("{t},1,{y}"));
    assert!(limitations(&diagnosed(&folder, &[])).contains("no held-out record can be judged"));
}

#[test]
fn one_period_is_refused_or_judged_with_a_word_about_it() {
    let folder = Folder::with_good_rig();
    for name in ["descendant.csv", "ascendant.csv"] {
        shorten(&folder, name, 15);
    }
    refused(&folder, &[], &["rig.toml", "samples"]);
    let folder = Folder::with_good_rig();
    shorten(&folder, "again.csv", 15);
    assert!(limitations(&diagnosed(&folder, &[])).contains("too short"));
}

#[test]
fn a_file_that_ends_in_the_middle_of_a_row_is_refused() {
    let folder = Folder::with_good_rig();
    folder.edit("again.csv", |text| text[..text.len() / 2].rsplit_once(',').expect("a comma").0.to_owned());
    refused(&folder, &[], &["again.csv:", "cells"]);
}

#[test]
fn a_clipped_output_is_diagnosed_as_such() {
    let folder = Folder::with_good_rig();
    for name in ["descendant.csv", "ascendant.csv", "again.csv"] {
        rewrite(&folder, name, "t,v,y", |[t, v, y]| format!("{t},{v},{}", y.min(0.7)));
    }
    let page = diagnosed(&folder, &[]);
    assert_eq!(page["verdict"]["effects"][0], "sensor_saturation", "{page:#}");
}

#[test]
fn a_model_of_another_order_is_refused() {
    let folder = Folder::with_good_rig();
    folder.write("model.json", &model_of(&folder).to_string());
    folder.edit("rig.toml", |text| text.replace("order = 2", "order = 3"));
    refused(&folder, &["--model", "model.json"], &["model.json", "order 2", "order = 3"]);
}

#[test]
fn a_file_that_is_no_model_is_refused_at_its_place() {
    let folder = Folder::with_good_rig();
    let model = ["--model", "model.json"];
    refused(&folder, &model, &["model.json", "no such file"]);
    folder.write("model.json", "");
    refused(&folder, &model, &["model.json", "empty"]);
    folder.write("model.json", "a = [1.0]\n");
    refused(&folder, &model, &["model.json:1:1", "no JSON", "switchback identify"]);
    folder.write("model.json", "{\"order\": 2,\n \"a\": 7}");
    refused(&folder, &model, &["model.json:2:"]);
}

#[test]
fn a_model_that_contradicts_itself_is_refused() {
    refused_model(|m| drop(m["a"].as_array_mut().map(Vec::pop)), &["`a` has 1", "`order` is 2"]);
    refused_model(|m| drop(m["b"].as_array_mut().map(Vec::pop)), &["`b` has 1", "order 2"]);
    refused_model(|m| drop(m.as_object_mut().map(|m| m.remove("gain"))), &["no field `gain`"]);
    refused_model(|m| m["gain"] = 9.0.into(), &["B(1)/A(1)", "9"]);
    refused_model(
        |m| m["ascendant"] = Value::Array(Vec::new()),
        &["`ascendant` has 0 points", "--method free"],
    );
    refused_model(
        |m| m["descendant"].as_array_mut().expect("points").reverse(),
        &["`descendant`", "increasing v"],
    );
    refused_model(|m| m["a"] = serde_json::json!([-2.5, 1.0]), &["unstable"]);
    refused_model(|m| m["a"][0] = Value::Null, &["model.json:1:", "a number"]);
}
