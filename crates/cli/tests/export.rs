//! `switchback export`: models run in C as they do in `switchback simulate`.
//!
//! Without a C compiler, what needs one says so and is left out.

use crate::common::{Folder, step};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Rises, falls, rests and small returns over nearly all of [−1, 1], to begin with a rise or a fall.
fn input(first: f64) -> Vec<f64> {
    let at = |t: i32| {
        let t = if t % 41 > 33 { t - t % 41 + 33 } else { t };
        let t = f64::from(t);
        first * (0.6 * (0.23 * t).sin() + 0.35 * (0.71 * t).sin())
    };
    (0..260).map(at).collect()
}

/// The visits of a pulse experiment, for models that know one border.
fn visits(satellite: f64) -> Vec<f64> {
    [-1.0, 1.0, 0.5, 1.0, 1.0, 0.0, 1.0, 1.0, -0.4, 1.0].repeat(12).iter().map(|v| satellite * v).collect()
}

fn write_input(folder: &Folder, v: &[f64]) {
    let rows: String = v.iter().map(|v| format!("{v:?}\n")).collect();
    folder.write("input.csv", &format!("v\n{rows}"));
}

fn succeed(folder: &Folder, arguments: &[&str]) {
    let output = folder.switchback(arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// The free run of `simulate` from rest on `input.csv`.
fn simulated(folder: &Folder, model: &str) -> Vec<f64> {
    succeed(
        folder,
        &["simulate", model, "input.csv", "--output", "none", "--out", "run.csv", "--force", "--quiet"],
    );
    let text = fs::read_to_string(folder.path("run.csv")).expect("a file");
    text.lines().skip(1).map(|line| line.split(',').nth(2).expect("y").parse().expect("a number")).collect()
}

fn compare(what: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = expected.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    for (t, (found, y)) in found.iter().zip(expected).enumerate() {
        assert!((found - y).abs() <= 1e-12 * size, "{what}, sample {t}: {found}, but simulate gives {y}");
    }
}

fn numbers(command: &mut Command) -> Vec<f64> {
    let output = command.output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && reported.is_empty(), "{reported}");
    let text = String::from_utf8(output.stdout).expect("text");
    text.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

/// The run of the C header, compiled with every warning an error.
fn in_c(folder: &Folder, model: &str, (v, border): (&[f64], i32)) -> Option<Vec<f64>> {
    if Command::new("cc").arg("--version").output().is_err() {
        eprintln!("SKIPPED: there is no C compiler `cc`");
        return None;
    }
    succeed(folder, &["export", model, "--to", "c", "--out", "exported.h", "--force", "--quiet"]);
    let values: Vec<String> = v.iter().map(|v| format!("{v:?}")).collect();
    let main = format!(
        "#include <stdio.h>\n#include \"exported.h\"\nstatic const double v[] = {{{}}};\nint main(void) {{\n    exported_state s;\n    int t;\n    \
         exported_start(&s, v[0], {border});\n    for (t = 0; t < {}; ++t) {{\n        printf(\"%.17g\\n\", exported_step(&s, v[t]));\n    }}\n    return 0;\n}}\n",
        values.join(", "),
        v.len()
    );
    folder.write("main.c", &main);
    let flags =
        ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O2", "main.c", "-o", "main", "-lm"];
    let directory = folder.path("");
    assert!(numbers(Command::new("cc").args(flags).current_dir(&directory)).is_empty());
    Some(numbers(&mut Command::new(folder.path("main"))))
}

/// C against `simulate`, for each input.
fn agrees(folder: &Folder, model: &str, inputs: &[Vec<f64>]) {
    for v in inputs {
        write_input(folder, v);
        let expected = simulated(folder, model);
        let first = v.iter().find(|x| **x != v[0]).expect("it moves");
        let knows_its_start = model.starts_with("report");
        let border = match (knows_its_start, first > &v[0]) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => -1,
        };
        if let Some(run) = in_c(folder, model, (v, border)) {
            compare(&format!("{model} in C"), &run, &expected);
        }
    }
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
fn every_method_of_identify() {
    let folder = with_step_records();
    for method in ["joint", "efficient", "free", "linear-arx", "memoryless"] {
        succeed(
            &folder,
            &["identify", "rig.toml", "--method", method, "--causal", "--out", "found", "--force", "--quiet"],
        );
        agrees(&folder, "found/model.json", &[input(1.0), input(-1.0)]);
    }
    for (method, satellite) in [("paper-descendant", 1.0), ("paper-ascendant", -1.0)] {
        succeed(
            &folder,
            &["identify", "rig.toml", "--method", method, "--out", "found", "--force", "--quiet"],
        );
        agrees(&folder, "found/model.json", &[visits(satellite)]);
    }
}

#[test]
fn orders_from_one_to_four() {
    let folder = Folder::with_good_rig();
    for order in ["1", "3", "4"] {
        folder.edit("rig.toml", |text| {
            let lines = text.lines().map(|line| match line.starts_with("order") {
                true => format!("order = {order}\n"),
                false => format!("{line}\n"),
            });
            lines.collect()
        });
        let identify =
            ["identify", "rig.toml", "--method", "free", "--causal", "--out", "found", "--force", "--quiet"];
        succeed(&folder, &identify);
        let text = fs::read_to_string(folder.path("found/model.json")).expect("a model");
        assert!(text.contains(&format!("\"order\": {order}")), "{text}");
        agrees(&folder, "found/model.json", &[input(1.0), input(-1.0)]);
    }
}

/// Noise on the input makes a threshold: in real time a reversal counts from where it is confirmed, which the file must say.
#[test]
fn a_causal_model_of_a_noisy_input() {
    let folder = Folder::with_good_rig();
    let mut seed = 5_u64;
    let mut white = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let (mut rows, mut y, mut u, mut last) = (String::from("t,v,y\n"), 0.0, 0.0, 0.0);
    for t in 0..4000 {
        let at = 0.01 * f64::from(t);
        let v = 0.6 * (2.3 * at).sin() + 0.4 * (0.7 * at).sin();
        y += 0.3 * (u - y) + 0.002 * white();
        u = 0.3 * v + if v > last { 0.2 } else { -0.2 };
        last = v;
        rows += &format!("{at:.2},{},{y}\n", v + 0.01 * white());
    }
    folder.write("noisy.csv", &rows);
    succeed(&folder, &["identify", "noisy.csv", "--method", "free", "--causal", "--out", "found", "--quiet"]);
    let text = fs::read_to_string(folder.path("found/model.json")).expect("a model");
    assert!(text.contains("\"at_confirmation\":true"), "{text}");
    agrees(&folder, "found/model.json", &[input(1.0), input(-1.0)]);
}

#[test]
fn models_of_gap_with_effects() {
    for (effect, order) in [("creep", "1"), ("backlash", "2"), ("sensor_saturation", "3")] {
        let folder = Folder::with_good_rig();
        succeed(
            &folder,
            &[
                "rig", "--effect", effect, "--size", "3", "--order", order, "--seed", "5", "--out", "made",
                "--quiet",
            ],
        );
        succeed(&folder, &["gap", "made/rig.toml", "--out", "report", "--quiet"]);
        for model in ["report/nominal.json", "report/augmented.json"] {
            agrees(&folder, model, &[input(1.0), input(-1.0)]);
        }
    }
}

/// Exit code 2, nothing written, and a message with all the words in it.
fn refused(folder: &Folder, arguments: &[&str], words: &[&str]) {
    let before = folder.listing();
    let output = folder.switchback(arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{reported}");
    assert!(reported.contains("help: "), "no remedy: {reported}");
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
    assert_eq!(folder.listing(), before, "nothing may be written");
}

#[test]
fn a_model_that_looks_ahead_is_refused_and_the_causal_one_named() {
    let folder = Folder::with_good_rig();
    succeed(&folder, &["identify", "rig.toml", "--method", "free", "--out", "found", "--quiet"]);
    folder.edit("found/model.json", |text| {
        let mut model: serde_json::Value = serde_json::from_str(text).expect("a model");
        model["model"]["rule"] =
            serde_json::json!({ "threshold": 0.1, "band": 0.0, "between_samples": false });
        model.to_string()
    });
    let words = ["found/model.json", "real time", "dates a reversal back", "identify RIG.toml --causal"];
    refused(&folder, &["export", "found/model.json", "--to", "c"], &words);
}

#[test]
fn what_is_no_model_or_no_target_is_reported() {
    let folder = Folder::with_good_rig();
    refused(&folder, &["export", "rig.toml", "--to", "c"], &["rig.toml"]);
    refused(&folder, &["export", "none.json", "--to", "c"], &["none.json"]);
    succeed(&folder, &["identify", "rig.toml", "--out", "found", "--quiet"]);
    let reported =
        folder.switchback(&["export", "found/model.json", "--to", "matlab"]).output().expect("it runs");
    assert_eq!(reported.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&reported.stderr).contains("fmu"));
    refused(
        &folder,
        &["export", "found/model.json", "--to", "fmu", "--library", "nowhere.so"],
        &["nowhere.so", "cargo build --release --locked -p switchback-fmu"],
    );
    // A file that is there is kept.
    folder.write("small.h", "mine");
    refused(&folder, &["export", "found/model.json", "--to", "c"], &["small.h", "--force"]);
}

#[test]
fn the_file_is_named_after_the_rig_and_says_what_it_is() {
    let folder = Folder::with_good_rig();
    succeed(&folder, &["identify", "rig.toml", "--out", "found", "--quiet"]);
    let reported = folder.switchback(&["export", "found/model.json", "--to", "c"]).output().expect("it runs");
    assert_eq!(String::from_utf8_lossy(&reported.stdout), "small.h\n");
    let text = fs::read_to_string(folder.path("small.h")).expect("a header");
    for words in ["The identified model of small", "small_step(&s, v)", "Sample time: 0.01 s", "from -1 to 1"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(Path::new(&folder.path("small.h")).exists());
}
