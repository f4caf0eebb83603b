//! `switchback design`: from a question to a measured and identified rig.

#[allow(dead_code, unreachable_pub, reason = "the example uses all of it")]
#[path = "../examples/design_precision/replicates.rs"]
mod replicates;

use assert_cmd::Command;
use replicates::{Machine, Planned, machines, rms};
use serde_json::Value;
use std::fs;
use std::path::Path;
use switchback_model::hysteresis::Branch;
use switchback_noise::StreamId;
use switchback_study::design::PlanMethod;
use tempfile::TempDir;

fn switchback(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::cargo_bin("switchback").expect("the binary is built");
    command.current_dir(folder).args(arguments).output().expect("it runs")
}

fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = switchback(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&done(folder, arguments)).expect("one JSON object on stdout")
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = switchback(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.stdout.is_empty(), "{}", String::from_utf8_lossy(&output.stdout));
    String::from_utf8(output.stderr).expect("text")
}

const FILES: [&str; 6] = ["step_high", "step_low", "descendant", "ascendant", "free", "holdout"];

const PLAN: [&str; 13] = [
    "design",
    "--order",
    "2",
    "--points",
    "8",
    "--interval",
    "-40,40",
    "--rate",
    "100",
    "--input",
    "travel [mm]",
    "--output",
    "force [N]",
];

fn plan<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&PLAN, more].concat()
}

/// Plays every record on a machine: the column y beside what was designed.
fn play(machine: &Machine, folder: &Path) {
    for (k, name) in FILES.into_iter().enumerate() {
        let file = folder.join(format!("{name}.csv"));
        let Ok(text) = fs::read_to_string(&file) else { continue };
        let v: Vec<f64> = text.lines().skip(1).map(|row| cell(row, 1)).collect();
        let y = machine.measure(&v, StreamId { seed: 11, experiment: k as u32, replicate: 0 });
        let mut measured = String::from("t,v,y\n");
        for (row, y) in text.lines().skip(1).zip(y) {
            measured.push_str(&format!("{row},{y}\n"));
        }
        fs::write(file, measured).expect("a writable folder");
    }
}

fn cell(row: &str, column: usize) -> f64 {
    row.split(',').nth(column).and_then(|cell| cell.parse().ok()).expect("a number")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// The second-order machine on ± 40.
fn spring() -> Machine {
    machines().into_iter().nth(1).expect("four machines")
}

#[test]
fn a_plan_is_written_whole_with_what_the_actuator_must_do() {
    let root = TempDir::new().expect("a folder");
    let reported = done(root.path(), &plan(&["--out", "bench"]));
    for word in
        ["descendant.csv", "8000 mm/s", "80.00 mm within one sample", "switchback identify bench/rig.toml"]
    {
        assert!(reported.contains(word), "`{word}` is missing in: {reported}");
    }
    for name in FILES {
        let text = fs::read_to_string(root.path().join("bench").join(format!("{name}.csv"))).expect("a file");
        assert!(text.starts_with("t,v\n"), "{name}");
        for (k, row) in text.lines().skip(1).enumerate() {
            assert!(
                (cell(row, 0) - 0.01 * k as f64).abs() < 1e-9 && cell(row, 1).abs() <= 40.0,
                "{name}: {row}"
            );
        }
    }
}

#[test]
fn a_rig_that_waits_for_its_output_says_so() {
    let root = TempDir::new().expect("a folder");
    done(root.path(), &plan(&["--out", "bench"]));
    for verb in ["identify", "gap"] {
        let reported = refused(root.path(), &[verb, "bench/rig.toml"]);
        assert!(
            reported.contains("step_high.csv")
                && reported.contains("column y is missing: play v and add the measured y"),
            "{reported}"
        );
    }
}

#[test]
fn nothing_is_replaced_unless_forced() {
    let root = TempDir::new().expect("a folder");
    done(root.path(), &plan(&["--out", "bench"]));
    play(&spring(), &root.path().join("bench"));
    let read = |name: &str| fs::read_to_string(root.path().join("bench").join(name)).expect("a file");
    let before = read("free.csv");
    let reported = refused(root.path(), &plan(&["--out", "bench"]));
    assert!(reported.contains("free.csv") && reported.contains("--force"), "{reported}");
    assert_eq!(read("free.csv"), before);
    done(root.path(), &plan(&["--out", "bench", "--force"]));
    assert!(read("free.csv").starts_with("t,v\n"));
}

#[test]
fn what_is_designed_and_played_identifies_the_machine() {
    let root = TempDir::new().expect("a folder");
    done(root.path(), &plan(&["--out", "bench"]));
    let machine = spring();
    play(&machine, &root.path().join("bench"));
    let found = json(root.path(), &["identify", "bench/rig.toml", "--json"]);
    assert_eq!(found["method"], "efficient");
    let span = machine.hysteresis.span();
    let within = |found: f64, truth: f64, se: f64| {
        assert!((found - truth).abs() < 4.0 * se, "{found}, {truth} ± {se}")
    };
    for (name, truth) in
        [("a", machine.system.a().to_vec()), ("b", machine.system.normalised(span).b().to_vec())]
    {
        let (values, errors) = (numbers(&found[name]), numbers(&found[format!("{name}_se")]));
        (0..2).for_each(|k| within(values[k], truth[k], errors[k]));
    }
    for (name, branch) in [("descendant", Branch::Descending), ("ascendant", Branch::Ascending)] {
        let points = found[name].as_array().expect("a list");
        assert_eq!(points.len(), 8);
        for point in points {
            let of = |key: &str| point[key].as_f64().expect("a number");
            within(of("f"), machine.hysteresis.border(branch, of("v")) / span, of("se"));
        }
    }
    // The free records are worth something by themselves, and the paper's method finds its step.
    let free = json(root.path(), &["identify", "bench/rig.toml", "--method", "free", "--json"]);
    let held_out = |page: &Value| page["fit_percent"]["holdout"].as_f64().expect("a figure");
    assert!(held_out(&free) > held_out(&found) - 3.0, "{free:#}");
    json(root.path(), &["identify", "bench/rig.toml", "--method", "paper-descendant", "--json"]);
}

#[test]
fn a_precision_is_planned_for_and_its_plan_written() {
    let root = TempDir::new().expect("a folder");
    done(root.path(), &plan(&["--out", "bench"]));
    play(&spring(), &root.path().join("bench"));
    let page = json(
        root.path(),
        &["design", "--from", "bench/rig.toml", "--precision", "1%", "--out", "next", "--json"],
    );
    assert_eq!(page["precision"], 0.01);
    let (period, periods) = (page["period"].as_u64().unwrap(), page["periods"].as_u64().unwrap());
    let worst = page["prediction"]["worst"].as_f64().expect("a number");
    assert!(
        worst <= 0.01 && worst > 0.01 * (1.0 - 1.0 / periods as f64),
        "no period more than needed: {worst}"
    );
    assert_eq!(page["samples"], period * periods);
    let rows = fs::read_to_string(root.path().join("next/descendant.csv")).expect("a file").lines().count();
    assert_eq!(rows as u64, period * periods + 2, "header and loading sample");
    let rig = fs::read_to_string(root.path().join("next/rig.toml")).expect("a file");
    assert!(rig.contains("travel [mm]") && rig.contains("interval = [-40.0, 40.0]"), "{rig}");
    // Half the error takes four times the samples.
    let finer = json(root.path(), &["design", "--from", "bench/rig.toml", "--precision", "0.005", "--json"]);
    let ratio = finer["samples"].as_f64().unwrap() / page["samples"].as_f64().unwrap();
    assert!((ratio - 4.0).abs() < 4.0 / periods as f64, "{ratio}");
    let reported = done(root.path(), &["design", "--from", "bench/rig.toml", "--precision", "1%"]);
    for word in
        ["worst descending point", "b2 N", "to know every border point to 1.0 %", "nothing was written"]
    {
        assert!(reported.contains(word), "`{word}` is missing in: {reported}");
    }
}

#[test]
fn a_rig_of_free_records_alone_is_enough_to_plan_from() {
    let root = TempDir::new().expect("a folder");
    done(root.path(), &plan(&["--free-only", "--out", "bench", "--max-speed", "400"]));
    assert!(!root.path().join("bench/descendant.csv").exists());
    play(&spring(), &root.path().join("bench"));
    let page = json(
        root.path(),
        &["design", "--from", "bench/rig.toml", "--precision", "0.01", "--points", "8", "--json"],
    );
    assert_eq!(
        (&page["rig"]["method"], &page["order"], &page["points"]),
        (&"free".into(), &2.into(), &8.into())
    );
    let from_free = page["samples"].as_f64().expect("a number");
    done(root.path(), &plan(&["--out", "pulses"]));
    play(&spring(), &root.path().join("pulses"));
    let page = json(root.path(), &["design", "--from", "pulses/rig.toml", "--precision", "0.01", "--json"]);
    let from_pulses = page["samples"].as_f64().expect("a number");
    // The free record knows b to a fifth, and N goes with its square; the noise must be that of the equation, not of the output.
    assert!((0.5..2.0).contains(&(from_free / from_pulses)), "{from_free} and {from_pulses}");
}

#[test]
fn one_experiment_is_enough_to_plan_both() {
    let root = TempDir::new().expect("a folder");
    done(root.path(), &plan(&["--out", "bench"]));
    play(&spring(), &root.path().join("bench"));
    let rig = root.path().join("bench/rig.toml");
    let text = fs::read_to_string(&rig).expect("a file");
    let without =
        text.replace("role = \"ascendant\"\nuse = \"fit\"", "role = \"ascendant\"\nuse = \"holdout\"");
    assert_ne!(text, without);
    fs::write(&rig, without).expect("a writable folder");
    let page = json(root.path(), &["design", "--from", "bench/rig.toml", "--precision", "0.01", "--json"]);
    assert_eq!(page["rig"]["method"], "paper-descendant");
    assert!(page["rig"]["notes"].to_string().contains("turned by half a turn"), "{page:#}");
}

#[test]
fn what_cannot_be_is_refused_with_the_remedy() {
    let root = TempDir::new().expect("a folder");
    for (arguments, words) in [
        (&["design", "--order", "2", "--rate", "100", "--out", "x"][..], &["--interval"][..]),
        (
            &["design", "--order", "2", "--interval", "1", "--rate", "100", "--out", "x"],
            &["two numbers", "-40,40"],
        ),
        (
            &["design", "--order", "2", "--interval", "1,-1", "--rate", "100", "--out", "x"],
            &["not an interval"],
        ),
        (&["design", "--order", "2", "--interval", "-1,1", "--rate", "-5", "--out", "x"], &["--rate"]),
        (&plan(&["--out", "x", "--periods", "2"]), &["`--periods 2` is too few", "`--periods 3` or more"]),
        (&plan(&["--out", "x", "--duration", "1"]), &["--duration", "2.3 s"]),
        (&plan(&["--out", "x", "--duration", "1e9"]), &["a file should hold"]),
        (&plan(&["--out", "x", "--max-speed", "500"]), &["8000/s", "6.25", "--free-only"]),
        (&plan(&["--out", "x", "--max-speed", "1", "--free-only"]), &["one stroke", "--periods 2182"]),
        (
            &plan(&["--out", "x", "--amplitude", "5,100"]),
            &["`--amplitude`", "the largest move, 100, does not fit into the interval −40…40", "MAX ≤ 80"],
        ),
        (&plan(&["--out", "x", "--amplitude", "-1,100"]), &["the smallest move, -1, is not positive"]),
        (
            &plan(&["--out", "x", "--amplitude", "20,10"]),
            &["the largest move, 10, is less than the smallest, 20"],
        ),
        (&plan(&["--out", "x", "--precision", "0.01"]), &["--from"]),
        (&["design", "--from", "none.toml", "--precision", "0.01"], &["none.toml"]),
    ] {
        let reported = refused(root.path(), arguments);
        words.iter().for_each(|word| assert!(reported.contains(word), "`{word}` is missing in: {reported}"));
    }
    assert_eq!(fs::read_dir(root.path()).expect("a folder").count(), 0, "nothing was written");
}

/// The whole chain, 2,000 replicates of two plans: of the system planned for, and of the machine that the pilot was measured on.
#[test]
fn a_plan_reaches_the_precision_that_it_promises() {
    for index in [0, 3] {
        let machine = &machines()[index];
        let planned = Planned::after_a_pilot(machine, PlanMethod::Efficient, 7);
        for system in [&planned.believed, machine] {
            let achieved = rms(&planned.ratios(system, PlanMethod::Efficient, 2000));
            println!("{}: achieved over predicted {achieved:.3}", machine.name);
            assert!((0.95..=1.05).contains(&achieved), "{}: {achieved}", machine.name);
        }
    }
}
