//! What people of the field bring: signals at rates of their own, clocks that shake, names and headers of all kinds. Each file is read at the first
//! attempt, and what was made of it is said.

mod cases;
mod clocks;
mod counters;
mod headers;
mod long_files;
mod plausibility;
mod rates;
mod roles;

use crate::common::bench_data::{Bench, SAMPLES, lines, point, rows, truth};
use std::fmt::Write;
use switchback_io::rig::{Loaded, RIG_FILE, manifest};
use switchback_model::Record;

/// Reads the bytes as a file, and again by the rig file that says what was inferred.
#[track_caller]
fn load(contents: impl AsRef<[u8]>, flags: &[&str]) -> Loaded {
    let bench = Bench::new().with("bench.csv", contents);
    let read = |words: &[&str]| {
        bench.load(words).unwrap_or_else(|error| panic!("{}", switchback_io::output::plain(&error)))
    };
    let loaded = read(&[&["bench.csv"], flags].concat());
    let folder = bench.path("");
    std::fs::write(bench.path(RIG_FILE), manifest(&loaded.plan, Some(&folder))).expect("a writable folder");
    let rig_file = bench.path(RIG_FILE).display().to_string();
    let again = read(&[rig_file.as_str()]);
    assert_eq!(again.rig.sample_time, loaded.rig.sample_time, "by its rig file");
    assert_eq!(signals(&again), signals(&loaded), "by its rig file");
    loaded
}

/// Inputs and outputs of all records, one after the other.
fn signals(loaded: &Loaded) -> [Vec<f64>; 2] {
    let all = |of: fn(&Record) -> &[f64]| -> Vec<f64> {
        loaded.rig.records.iter().flat_map(|record| of(&record.record).to_vec()).collect()
    };
    [all(Record::v), all(Record::y)]
}

/// Whether the file gives the record that was written, with a word on how.
#[track_caller]
fn is_the_record(contents: impl AsRef<[u8]>, flags: &[&str], said: &str) -> Loaded {
    let loaded = load(contents, flags);
    let (v, y) = truth();
    let [found_v, found_y] = signals(&loaded);
    assert_eq!(loaded.rig.sample_time, 0.01, "{}", loaded.reported);
    assert_eq!((found_v.len(), found_y.len()), (v.len(), y.len()), "{}", loaded.reported);
    assert_close(&found_v, &v, 1e-9);
    assert_close(&found_y, &y, 1e-9);
    assert!(loaded.reported.to_string().contains(said), "`{said}` is not in:\n{}", loaded.reported);
    loaded
}

#[track_caller]
fn assert_close(found: &[f64], wanted: &[f64], tolerance: f64) {
    assert_eq!(found.len(), wanted.len());
    let far = found.iter().zip(wanted).position(|(found, wanted)| (found - wanted).abs() > tolerance);
    assert_eq!(far, None, "{:?} instead of {:?}", far.map(|k| found[k]), far.map(|k| wanted[k]));
}

/// A header and rows of cells, each made of its number, time, input and output.
fn table(header: &str, row: impl Fn(usize, f64, f64, f64) -> String) -> String {
    let body = rows().enumerate().map(|(k, (t, v, y))| row(k, t, v, y) + "\n");
    std::iter::once(format!("{header}\n")).chain(body).collect()
}

/// The message about a file that is refused.
fn refusal(contents: impl AsRef<[u8]>) -> String {
    Bench::new().with("bench.csv", contents).refusal(&["bench.csv"])
}
