//! Tables of thousands of columns, as logs of cars are.

use super::*;
use std::time::{Duration, Instant};

/// It takes a tenth of it.
const PATIENCE: Duration = Duration::from_secs(30);

/// Twenty rows of many columns that move, each called by its number.
fn columns(count: usize, name: impl Fn(usize) -> String) -> Vec<(String, Vec<f64>)> {
    let values = |k: usize| (0..20).map(|row| ((7 * k + 13 * row) % 97) as f64).collect();
    (0..count).map(|k| (name(k), values(k))).collect()
}

fn read(columns: &[(String, Vec<f64>)]) -> (Result<Measured, String>, Duration) {
    let columns: Vec<(&str, &[f64])> =
        columns.iter().map(|(name, values)| (name.as_str(), &values[..])).collect();
    let begun = Instant::now();
    (inferred(&columns), begun.elapsed())
}

#[test]
fn many_columns_are_looked_at_in_time() {
    let names: [fn(usize) -> String; 4] = [
        |k| format!("gauge {k}"),
        |_| "v".to_owned(),
        |k| format!("axis {} {}", k / 2, ["cmd", "raw"][k % 2]),
        |k| format!("stamp {} {}", k / 2, ["ns", "s"][k % 2]),
    ];
    for name in names {
        let (_, taken) = read(&columns(1500, name));
        assert!(taken < PATIENCE, "{}: {taken:?}", name(0));
    }
}

#[test]
fn a_command_and_its_response_are_found_among_many() {
    let machine = Machine::new(1);
    let others: Vec<(String, Vec<f64>)> =
        (0..500).map(|k| (format!("gauge {k}"), bystander(30.0, k as u64))).collect();
    let mut columns: Vec<(&str, &[f64])> =
        others.iter().map(|(name, values)| (name.as_str(), &values[..])).collect();
    columns.insert(100, ("pedal pos", &machine.output));
    columns.insert(400, ("pedal cmd", &machine.input));
    let measured = inferred(&columns).expect("a pair");
    assert_taken(&measured, ["pedal cmd", "pedal pos"], None);
}
