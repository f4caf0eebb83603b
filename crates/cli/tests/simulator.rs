//! A machine beside simulators of it, and beside its records of another day: every sentence is about what differs between both.

use crate::common::Folder;
use serde_json::Value;
use std::fmt::Write;

/// A spring with a play of 1 mm and a friction of 5 N behind a second order, 200 samples a second.
fn machine(v: &[f64], play: f64) -> Vec<f64> {
    let (omega, zeta) = (0.38, 0.6);
    let radius = f64::exp(-zeta * omega);
    let (a1, a2) = (-2.0 * radius * (omega * f64::sqrt(1.0 - zeta * zeta)).cos(), radius * radius);
    let (mut p, mut side, mut before, mut earlier) = (v[0], 1.0, 5.0, 5.0);
    let sample = |v: &f64| {
        let q = p.clamp(v - 0.5 * play, v + 0.5 * play);
        side = if q > p {
            1.0
        } else if q < p {
            -1.0
        } else {
            side
        };
        p = q;
        let y = (1.0 + a1 + a2) * (p + 5.0 * side) - a1 * before - a2 * earlier;
        (before, earlier) = (y, before);
        y
    };
    v.iter().map(sample).collect()
}

/// Numbers from 0 to 1.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn walk(samples: usize, seed: u64) -> Vec<f64> {
    let (mut random, mut v, mut target, mut step) = (random(seed), 0.0, 0.0_f64, 0.1_f64);
    let sample = |_| {
        if (target - v).abs() < step.abs() {
            target = 40.0 * random() - 20.0;
            step = (0.1 + 0.7 * random()).copysign(target - v);
        }
        v += step;
        v
    };
    (0..samples).map(sample).collect()
}

/// Rows of measurements, with the predictions of a simulator where there are any.
fn table(v: &[f64], y: &[f64], predicted: Option<&[f64]>) -> String {
    let mut noise = random(99);
    let mut text =
        format!("time [s],travel [mm],force [N]{}\n", if predicted.is_some() { ",y_sim" } else { "" });
    for t in 0..v.len() {
        let error = 0.3 * ((0..12).map(|_| noise()).sum::<f64>() - 6.0);
        let _ = write!(text, "{:.3},{:.5},{:.4}", 0.005 * t as f64, v[t], y[t] + error);
        if let Some(predicted) = predicted {
            let _ = write!(text, ",{:.5}", predicted[t]);
        }
        text.push('\n');
    }
    text
}

/// The folder of a machine and a simulator whose prediction is a change of the right one.
fn folder(change: impl Fn(&[f64]) -> Vec<f64>) -> Folder {
    let v = walk(4000, 5);
    let y = machine(&v, 1.0);
    let folder = Folder::with_good_rig();
    folder.write("record.csv", &table(&v, &y, Some(&change(&y))));
    folder
}

fn run(folder: &Folder, arguments: &[&str]) -> (Option<i32>, String) {
    let output = folder.switchback(arguments).output().expect("it runs");
    let text = String::from_utf8(output.stdout).expect("text").replace('\n', " ");
    (output.status.code(), text + &String::from_utf8_lossy(&output.stderr))
}

fn json(folder: &Folder, arguments: &[&str]) -> Value {
    let output = folder.switchback(arguments).output().expect("it runs");
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

/// The names of the values that differ.
fn off(page: &Value) -> Vec<&str> {
    let rows = page["differences"].as_array().expect("a list").iter();
    rows.filter(|row| row["differs"] == true).map(|row| row["what"].as_str().expect("a name")).collect()
}

/// The row of a value.
fn row<'a>(page: &'a Value, what: &str) -> &'a Value {
    let mut rows = page["differences"].as_array().expect("a list").iter();
    rows.find(|row| row["what"] == what).unwrap_or_else(|| panic!("no {what}"))
}

#[test]
fn a_simulator_that_is_a_sample_late_is_late_and_nothing_else() {
    let late = |y: &[f64]| (0..y.len()).map(|t| y[t.saturating_sub(1)]).collect();
    let folder = folder(late);
    let (code, text) = run(&folder, &["gap", "record.csv"]);
    assert_eq!(code, Some(0), "{text}");
    for words in [
        "y_sim answers 0.00",
        "later than the machine",
        "of delay out of it",
        "what remains is the noise floor",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("lacks"), "{text}");
    let page = json(&folder, &["gap", "record.csv", "--json"]);
    assert_eq!((&page["verdict"]["status"], off(&page)), (&"parameters".into(), vec!["delay"]));
    let delay = &page["differences"][0];
    assert!((delay["in_a"].as_f64().expect("a number") - 0.005).abs() < 3e-4, "{delay:#}");
    assert_eq!((&delay["in_b"], &delay["unit"]), (&Value::from(0.0), &"s".into()));
    // A team's check of its simulator.
    let expect = |what: &str| run(&folder, &["gap", "record.csv", "--quiet", "--expect", what]).0;
    assert_eq!((expect("delay = 0"), expect("friction within 5 %")), (Some(1), Some(0)));
}

#[test]
fn a_turned_sign_and_another_unit_are_no_cause() {
    let page = |factor: f64| {
        let folder = folder(|y| y.iter().map(|y| factor * y).collect());
        (json(&folder, &["gap", "record.csv", "--json"]), run(&folder, &["gap", "record.csv"]).1)
    };
    let (turned, words) = page(-1.0);
    assert_eq!((&turned["verdict"]["status"], off(&turned)), (&"parameters".into(), vec!["gain"]));
    assert!(words.contains("the sign of y_sim is turned"), "{words}");
    // All values are the machine's: friction is positive.
    let friction = row(&turned, "friction");
    assert!(["in_a", "in_b"].iter().all(|side| (friction[*side].as_f64().unwrap() - 5.0).abs() < 0.2));
    let (thousand, words) = page(1000.0);
    assert_eq!(off(&thousand), ["gain"]);
    assert!(words.contains("compare the units of both"), "{words}");
    assert!((row(&thousand, "friction")["in_b"].as_f64().unwrap() - 5.0).abs() < 0.2, "{thousand:#}");
}

#[test]
fn predictions_in_another_unit_of_the_header_are_converted() {
    let v = walk(4000, 5);
    let y = machine(&v, 1.0);
    let milli: Vec<f64> = y.iter().map(|y| 1000.0 * y).collect();
    let folder = Folder::with_good_rig();
    let text = table(&v, &y, Some(&milli));
    folder.write("record.csv", &text.replacen("y_sim", "y_sim [mN]", 1));
    let (code, words) = run(&folder, &["gap", "record.csv"]);
    assert_eq!(code, Some(0), "{words}");
    assert!(words.contains("`y_sim [mN]` (converted to N)"), "{words}");
    assert!(off(&json(&folder, &["gap", "record.csv", "--json"])).is_empty(), "{words}");
    folder.write("record.csv", &text.replacen("y_sim", "y_sim [mm]", 1));
    let (_, words) = run(&folder, &["gap", "record.csv"]);
    assert!(words.contains("a unit of another quantity"), "{words}");
}

/// A swept sine through a machine of second order with noise in its sensor; `[amplitude, last frequency, natural frequency, damping]`.
fn swept([amplitude, last, natural, zeta]: [f64; 4], seed: u64) -> String {
    let omega = std::f64::consts::TAU * natural * 0.005;
    let (radius, angle) = (f64::exp(-zeta * omega), omega * f64::sqrt(1.0 - zeta * zeta));
    let (a1, a2) = (-2.0 * radius * angle.cos(), radius * radius);
    let (mut noise, mut before, mut earlier, mut last_v, mut side) = (random(seed), 0.0, 0.0, 0.0, 1.0);
    let mut text = String::from("time [s],command,angle\n");
    for k in 0..4000 {
        let t = 0.005 * f64::from(k);
        let v = amplitude * (std::f64::consts::TAU * (0.1 * t + (last - 0.1) / 40.0 * t * t)).sin();
        side = if v == last_v { side } else { f64::signum(v - last_v) };
        last_v = v;
        let y = (1.0 + a1 + a2) * (v + 2.0 * side) - a1 * before - a2 * earlier;
        (before, earlier) = (y, before);
        let error = 0.2 * ((0..12).map(|_| noise()).sum::<f64>() - 6.0);
        let _ = writeln!(text, "{t:.3},{v:.5},{:.4}", y + error);
    }
    text
}

#[test]
fn dynamics_of_the_machine_itself_are_no_cause() {
    let folder = Folder::with_good_rig();
    for (k, machine) in
        [[8.0, 5.0, 12.0, 0.6], [10.0, 5.0, 9.0, 0.5], [12.0, 4.0, 7.0, 0.6]].into_iter().enumerate()
    {
        folder.write("record.csv", &swept(machine, 40 + k as u64));
        let page = json(&folder, &["gap", "record.csv", "--json"]);
        let named = page["verdict"]["effects"].as_array().expect("a list");
        assert!(named.iter().all(|e| e != "resonance" && e != "extra_pole"), "{machine:?} {page:#}");
    }
}

#[test]
fn a_simulator_that_is_right_misses_nothing_and_one_without_the_play_lacks_it() {
    let page = json(&folder(<[f64]>::to_vec), &["gap", "record.csv", "--json"]);
    assert_eq!((&page["verdict"]["status"], off(&page)), (&"none".into(), vec![]), "{page:#}");
    let v = walk(4000, 5);
    let stiff = machine(&v, 0.0);
    let folder = folder(|_| stiff.clone());
    let page = json(&folder, &["gap", "record.csv", "--json", "--out", "report"]);
    assert_eq!(page["verdict"]["effects"], serde_json::json!(["backlash"]), "{page:#}");
    let play = &page["differences"][0];
    assert!((play["in_b"].as_f64().expect("a number") - 1.0).abs() < 0.05 && play["in_a"] == 0.0, "{play:#}");
    // The source with the values of the machine simulates that.
    let (code, text) = run(&folder, &["simulate", "report/aligned.json", "record.csv", "--out", "run.csv"]);
    assert_eq!(code, Some(0), "{text}");
    let fit =
        text.split("fit ").nth(1).and_then(|rest| rest.split(' ').next()).and_then(|x| x.parse::<f64>().ok());
    assert!(fit.is_none_or(|fit| fit > 97.0), "{text}");
    assert!(folder.path("report/index.html").exists());
}

#[test]
fn another_day_is_compared_by_its_records() {
    let (monday, tuesday) = (walk(4000, 6), walk(3000, 7));
    let folder = Folder::with_good_rig();
    folder.write("monday.csv", &table(&monday, &machine(&monday, 1.0), None));
    let tared: Vec<f64> = machine(&tuesday, 1.0).iter().map(|y| y + 1.7).collect();
    folder.write("tuesday.csv", &table(&tuesday, &tared, None));
    let page = json(&folder, &["gap", "tuesday.csv", "--against", "monday.csv", "--json"]);
    assert_eq!((&page["model"], off(&page)), (&"against".into(), vec!["offset"]), "{page:#}");
    let offset = &page["differences"][0];
    assert!((offset["in_b"].as_f64().expect("a number") - 1.7).abs() < 0.1, "{offset:#}");
    // Another range of the input cannot be compared, and another unit is refused.
    let far: Vec<f64> = monday.iter().map(|v| v + 1e5).collect();
    folder.write("far.csv", &table(&far, &machine(&monday, 1.0), None));
    let refused = |file: &str, words: &str| {
        let (code, text) = run(&folder, &["gap", "tuesday.csv", "--against", file]);
        assert!(code == Some(2) && text.contains(words) && text.contains("help: "), "{text}");
    };
    refused("far.csv", "hardly overlap");
    let other = table(&monday, &machine(&monday, 1.0), None).replace("[mm]", "[m]");
    folder.write("metres.csv", &other);
    refused("metres.csv", "[m]");
}

#[test]
fn a_zero_or_a_sign_that_differs_between_two_days_comes_first() {
    let folder = Folder::with_good_rig();
    let (monday, tuesday) = (walk(2000, 6), walk(1500, 7));
    folder.write("monday.csv", &table(&monday, &machine(&monday, 1.0), None));
    let changed = |sign: f64, zero: f64| {
        let y: Vec<f64> = machine(&tuesday, 1.0).into_iter().map(|y| sign * y + zero).collect();
        folder.write("tuesday.csv", &table(&tuesday, &y, None));
        json(&folder, &["gap", "monday.csv", "tuesday.csv", "--json"])
    };
    // Within three standard errors, and known to a few hundredths.
    let is = |page: &serde_json::Value, which: &str, wanted: Option<f64>| {
        let estimate = &page["shifts"][0][which];
        match (estimate["value"].as_f64(), estimate["half_width"].as_f64(), wanted) {
            (Some(found), Some(half), Some(wanted)) => (found - wanted).abs() < 1.5 * half && half < 0.05,
            (found, _, wanted) => found == wanted,
        }
    };
    for (sign, zero, words) in [(1.0, 1.7, "zero is another"), (-1.0, 0.0, "sign is another")] {
        let page = changed(sign, zero);
        let unlike = |value: f64, usual: f64| Some(value).filter(|value| *value != usual);
        assert!(is(&page, "offset", unlike(zero, 0.0)) && is(&page, "gain", unlike(sign, 1.0)), "{page:#}");
        assert!(page["in_words"][0].as_str().is_some_and(|sentence| sentence.contains(words)), "{page:#}");
        // A play of these records is all but a gradual transition.
        let listed =
            ["effects", "class"].map(|key| page["verdict"][key].as_array().cloned().unwrap_or_default());
        assert!(listed.concat().contains(&"backlash".into()), "{page:#}");
        assert!(page["gap"]["closure"]["estimate"].as_f64().is_some_and(|share| share > 0.9), "{page:#}");
    }
}

#[test]
fn parts_of_the_records_are_asked_for_the_same_verdict() {
    let folder = folder(|y| y.iter().map(|y| 1.2 * y).collect());
    let page = json(&folder, &["gap", "record.csv", "--stability", "2", "--json", "--quiet"]);
    let stability = &page["stability"];
    assert_eq!(stability["samples"].as_array().map(Vec::len), Some(2));
    // One recording: none is judged alone.
    assert_eq!(stability["recordings"].as_array().map(Vec::len), Some(0));
    assert_eq!(stability["share"], 1.0, "{stability}");
    let (code, refused) = run(&folder, &["gap", "record.csv", "--stability", "0"]);
    assert!(code == Some(2) && refused.contains("1..=1000"), "{refused}");

    // The second recording is of a machine without play.
    let v = walk(4000, 6);
    folder.write("monday.csv", &table(&v, &machine(&v, 1.0), None));
    folder.write("tuesday.csv", &table(&v, &machine(&v, 0.0), None));
    let (_, words) = run(&folder, &["gap", "monday.csv", "tuesday.csv", "--stability", "1"]);
    assert!(words.contains("recordings alone"), "{words}");
    assert!(words.contains("tuesday alone says: "), "{words}");
    let page = json(&folder, &["gap", "record.csv", "--json", "--quiet"]);
    assert!(page.get("stability").is_none());
}
