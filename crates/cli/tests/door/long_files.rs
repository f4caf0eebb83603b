//! Files that are looked at part by part.

use super::*;

/// The record over and over, with a clock that goes on: 34 MB, which is long enough to be looked at part by part.
fn long(last: &str) -> String {
    let (v, y) = truth();
    let mut text = String::from("time [s],travel [mm],force [N]\n");
    let mut row = 0;
    while text.len() < 34 << 20 {
        let (k, turn) = (row % SAMPLES, row / SAMPLES % 2);
        // There and back, so that nothing jumps.
        let k = if turn == 0 { k } else { SAMPLES - 1 - k };
        let _ = writeln!(text, "{:.2},{},{}", row as f64 / 100.0, v[k], y[k]);
        row += 1;
    }
    text + last
}

#[test]
fn init_says_the_same_of_a_long_file_as_of_one_that_is_read_whole() {
    let bench = Bench::new().with("bench.csv", long(""));
    let survey = bench.survey("bench.csv").expect("a good file");
    let loaded = bench.load(&["bench.csv"]).expect("a good file");
    assert_eq!(manifest(&survey.plan, None), manifest(&loaded.plan, None));
    let samples: usize = loaded.rig.records.iter().map(|record| record.record.len()).sum();
    let reported = survey.reported.to_string();
    assert!(reported.contains(&format!("{samples} samples looked at in")), "{reported}");
}

#[test]
fn a_fault_at_the_end_of_a_long_file_is_reported() {
    let bench = Bench::new().with("bench.csv", long("1e9,oops,1\n1e9,2,1\n"));
    let error = bench.survey("bench.csv").expect_err("a bad file");
    assert!(switchback_io::output::plain(&error).contains("`oops` is not a number"));
}
