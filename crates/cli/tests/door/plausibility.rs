//! What cannot be, said with its figure.

use super::*;

#[test]
fn records_in_other_units_are_reported_with_the_factor() {
    let metres = table("time,travel,force", |_, t, v, y| format!("{t},{},{y}", v / 1000.0));
    let bench = Bench::new().with("a.csv", table("time,travel,force", |_, t, v, y| format!("{t},{v},{y}")));
    let loaded = bench.with("b.csv", metres).load(&["a.csv", "b.csv"]).expect("good files");
    let reported = loaded.reported.to_string();
    assert!(reported.contains("1000 times as much: check that both are in one unit"), "{reported}");
    let lengths = table("time,command [m],position [mm]", |_, t, v, y| format!("{t},{v},{y}"));
    let reported = load(lengths, &[]).reported.to_string();
    assert!(reported.contains("the gain holds a factor of 1000"), "{reported}");
}

#[test]
fn strokes_that_are_all_alike_are_reported() {
    let sine = |k: usize| 10.0 * (0.1 * k as f64).sin();
    let text = table("time,travel,force", |k, t, _, y| format!("{t},{},{}", sine(k), y + sine(k)));
    let reported = load(text, &[]).reported.to_string();
    assert!(reported.contains("strokes of `travel` run between -10 and 10"), "{reported}");
    let free = table("time,travel,force", |_, t, v, y| format!("{t},{v},{y}"));
    assert!(!load(free, &[]).reported.to_string().contains("strokes"));
}

#[test]
fn outputs_outside_a_model_s_band_are_reported() {
    let good = table("time,travel,force", |_, t, v, y| format!("{t},{v},{y}"));
    let other = table("time,travel,force", |_, t, v, y| format!("{t},{v},{}", y + 100.0));
    let bench = Bench::new().with("a.csv", good).with("b.csv", other);
    assert!(
        bench
            .switchback(&["identify", "a.csv", "--out", "found", "--quiet"])
            .output()
            .expect("it runs")
            .status
            .success()
    );
    let said = |file: &str| {
        let run =
            bench.switchback(&["simulate", "found/model.json", file, "--out", "run.csv", "--force"]).output();
        let run = run.expect("it runs");
        String::from_utf8_lossy(&[run.stdout, run.stderr].concat()).into_owned()
    };
    assert!(said("b.csv").contains("of the measured outputs lie within the 95 % band"), "{}", said("b.csv"));
    assert!(!said("a.csv").contains("outputs lie within"), "{}", said("a.csv"));
}
