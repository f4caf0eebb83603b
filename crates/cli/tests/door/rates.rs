//! Signals at rates of their own.

use super::*;
use switchback_io::rig::{ColumnNames, Sampling, read_input};

/// The input at every `every`th row only, straight lines between.
fn straight(every: usize) -> Vec<f64> {
    let (v, _) = truth();
    let value = |k: usize| {
        let (left, share) = (k / every * every, (k % every) as f64 / every as f64);
        v[left] + share * (v.get(left + every).unwrap_or(&0.0) - v[left])
    };
    (0..=(SAMPLES - 1) / every * every).map(value).collect()
}

#[test]
fn blanks_of_a_slow_input_are_filled() {
    let blank = |k: usize, t: f64, v: f64, y: f64| {
        if k.is_multiple_of(4) { format!("{t},{v},{y}") } else { format!("{t},,{y}") }
    };
    let text = table("time,travel,force", blank);
    let loaded = load(&text, &[]);
    let reported = loaded.reported.to_string();
    assert!(reported.contains("`travel` at 25 Hz, `force` at 100 Hz"), "{reported}");
    assert!(reported.contains("interpolated linearly"), "{reported}");
    assert_close(&signals(&loaded)[0], &straight(4), 1e-9);
    let held = load(&text, &["--resample", "hold"]);
    assert!(held.reported.to_string().contains("held between its values"), "{}", held.reported);
}

#[test]
fn runs_of_equal_values_are_a_slower_rate() {
    let (v, _) = truth();
    let text = table("time,travel,force", |k, t, _, y| format!("{t},{},{y}", v[k - k % 4]));
    let loaded = load(&text, &[]);
    let reported = loaded.reported.to_string();
    assert!(reported.contains("`travel` changes at every 4th row only, at 25 Hz"), "{reported}");
    assert_close(&signals(&loaded)[0], &straight(4), 1e-9);
}

#[test]
fn an_input_that_the_machine_holds_is_held() {
    let (v, _) = truth();
    let mut y = 0.0;
    let responses: Vec<f64> = (0..SAMPLES)
        .map(|k| {
            let before = k.saturating_sub(1);
            y += 0.5 * (v[before - before % 4] - y);
            y
        })
        .collect();
    let text = table("time,travel,force", |k, t, _, _| format!("{t},{},{}", v[k - k % 4], responses[k]));
    let loaded = load(text, &[]);
    assert!(loaded.reported.to_string().contains("taken as held between"), "{}", loaded.reported);
    assert_eq!(signals(&loaded)[0][1], v[0]);
}

#[test]
fn an_output_that_is_slower_sets_the_rate() {
    for is_held in [true, false] {
        let (_, y) = truth();
        let text = table("time,travel,force", |k, t, v, _| match (k % 3, is_held) {
            (0, _) => format!("{t},{v},{}", y[k]),
            (_, true) => format!("{t},{v},{}", y[k - k % 3]),
            (_, false) => format!("{t},{v},"),
        });
        let loaded = load(text, &[]);
        assert_eq!(loaded.rig.sample_time, 0.03, "{}", loaded.reported);
        assert!(loaded.reported.to_string().contains("33.33 Hz"), "{}", loaded.reported);
    }
}

#[test]
fn signals_on_rows_of_their_own_are_joined() {
    let text = table("time,travel,force", |_, t, v, y| format!("{t:.4},{v},\n{:.4},,{y}", t + 0.0004));
    let loaded = load(&text, &[]);
    assert_eq!(loaded.rig.sample_time, 0.01);
    assert!(signals(&loaded)[1].len() >= SAMPLES - 1, "{}", loaded.reported);
    assert!(loaded.reported.to_string().contains("at 100 Hz"), "{}", loaded.reported);
    // A model runs on the same samples.
    let bench = Bench::new().with("bench.csv", text);
    let sampling = Sampling { sample_time: Some(0.01), resample: None };
    let input =
        read_input(&bench.path("bench.csv"), &ColumnNames::default(), sampling, "switchback simulate")
            .unwrap_or_else(|error| panic!("{}", switchback_io::output::plain(&error)));
    assert_eq!((&input.v, input.y.as_ref()), (&signals(&loaded)[0], Some(&signals(&loaded)[1])));
}

#[test]
fn rows_in_which_nothing_changed_are_none() {
    let coarse = |x: f64| (x / 2.0).round();
    let (v, y) = truth();
    let kept = |k: usize| {
        k == 0 || k + 1 == SAMPLES || coarse(v[k]) != coarse(v[k - 1]) || coarse(y[k]) != coarse(y[k - 1])
    };
    let text: String = std::iter::once("time,travel,force\n".to_owned())
        .chain(
            rows()
                .enumerate()
                .filter(|(k, _)| kept(*k))
                .map(|(_, (t, v, y))| format!("{t},{},{}\n", coarse(v), coarse(y))),
        )
        .collect();
    let loaded = load(text, &[]);
    assert!(loaded.reported.to_string().contains("nothing changed were not logged"), "{}", loaded.reported);
    assert_close(&signals(&loaded)[0], &v.iter().map(|v| coarse(*v)).collect::<Vec<_>>(), 1e-9);
}

#[test]
fn signals_with_clocks_of_their_own_are_joined_on_time() {
    let (_, y) = truth();
    let text = table("u_time [ms],travel,y_time [ms],force", |k, t, v, _| {
        let late = 2 * k;
        match late < SAMPLES {
            true => format!("{},{v},{},{}", 1000.0 * t, 10 * late, y[late]),
            false => format!("{},{v},,", 1000.0 * t),
        }
    });
    let loaded = load(text, &[]);
    assert_eq!(loaded.rig.sample_time, 0.02);
    let (v, y) = truth();
    let every_second = |of: &[f64]| of.iter().step_by(2).copied().collect::<Vec<_>>();
    assert_close(&signals(&loaded)[0], &every_second(&v), 1e-9);
    assert_close(&signals(&loaded)[1], &every_second(&y), 1e-9);
    assert!(loaded.reported.to_string().contains("has a clock of its own"), "{}", loaded.reported);
}
