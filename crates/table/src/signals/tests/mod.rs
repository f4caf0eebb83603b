//! Which columns of made tables are taken, and what is said of them.

mod clocks;
mod data;
mod many;
mod names;

use super::{ColumnNames, InputForm, Measured, Request, Sampling};
use crate::table::{Cells, Table};

pub(super) const SAMPLES: usize = 800;

/// A reference, a machine that follows it with friction, and its force, as a logger prints them.
pub(super) struct Machine {
    pub(super) input: Vec<f64>,
    pub(super) output: Vec<f64>,
}

pub(super) fn printed(x: f64) -> f64 {
    (x * 1e3).round() / 1e3
}

/// Numbers between −1 and 1 that look like noise.
pub(super) fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
    }
}

/// A signal about a mean that says nothing of others: a temperature, a supply.
pub(super) fn bystander(mean: f64, seed: u64) -> Vec<f64> {
    let mut noise = noise(seed);
    (0..SAMPLES).map(|_| printed(mean + 0.05 * noise())).collect()
}

impl Machine {
    pub(super) fn new(seed: u64) -> Self {
        let input: Vec<f64> = (0..SAMPLES)
            .map(|k| 0.01 * k as f64)
            .map(|t| printed(12.0 * (5.1 * t).sin() * (0.9 * t).cos() + 3.0 * (13.0 * t).sin()))
            .collect();
        let (mut y, mut u, mut noise) = (0.0, 0.0, noise(seed));
        let output = (0..SAMPLES)
            .map(|k| {
                y += 0.5 * (u - y) + 0.05 * noise();
                let step = input[k] - input[k.saturating_sub(1)];
                u = if step == 0.0 { u } else { 2.0 * input[k] + 6.0 * step.signum() };
                printed(y)
            })
            .collect();
        Self { input, output }
    }
}

/// What is inferred of columns at 100 Hz beside a time in seconds.
pub(super) fn inferred(columns: &[(&str, &[f64])]) -> Result<Measured, String> {
    let time: Vec<f64> = (0..columns[0].1.len()).map(|k| printed(0.01 * k as f64)).collect();
    let all: Vec<(&str, &[f64])> =
        std::iter::once(("time [s]", &time[..])).chain(columns.iter().copied()).collect();
    read(&all, &ColumnNames::default(), None)
}

pub(super) fn read(
    columns: &[(&str, &[f64])],
    names: &ColumnNames,
    sample_time: Option<f64>,
) -> Result<Measured, String> {
    let cells = |values: &[f64]| Cells::Texts(values.iter().map(f64::to_string).collect());
    let columns = columns.iter().map(|(name, values)| ((*name).to_owned(), cells(values))).collect();
    let input_form = InputForm::CommandLine("switchback init a.csv".to_owned());
    let sampling = Sampling { sample_time, resample: None };
    let request = Request { names, sampling, input_form: &input_form, needs_output: true };
    Measured::of(Table::of_columns("a.csv", columns), request).map_err(|problems| format!("{problems:?}"))
}

/// Input and output by name, and whether that is in doubt.
#[track_caller]
pub(super) fn assert_taken(measured: &Measured, [input, output]: [&str; 2], doubt: Option<&str>) {
    let found = measured.output().map(|output| output.name.clone()).unwrap_or_default();
    assert_eq!([&measured.input().name, &found], [input, output], "{:?}", measured.doubts);
    match doubt {
        Some(doubt) => {
            assert!(measured.doubts.iter().any(|said| said.contains(doubt)), "{:?}", measured.doubts);
        }
        None => assert_eq!(measured.doubts, Vec::<String>::new()),
    }
}
