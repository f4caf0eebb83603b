//! Seconds in one column and their fraction in another, as ROS writes them: `stamp.sec` and `stamp.nanosec`.

use super::spelling::simplified;
use crate::table::{Column, Kind, Table};
use std::collections::HashMap;

/// What the fraction's column is called behind a shared prefix, and its unit in nanoseconds.
const FRACTIONS: [(&str, i128); 10] = [
    ("nanosec", 1),
    ("nanosecs", 1),
    ("nanoseconds", 1),
    ("nsec", 1),
    ("nsecs", 1),
    ("ns", 1),
    ("usec", 1000),
    ("usecs", 1000),
    ("microseconds", 1000),
    ("us", 1000),
];
const SECONDS: [&str; 6] = ["sec", "secs", "seconds", "s", "tv sec", "second"];

/// Joins both to time stamps in the place of the first; says which.
pub(super) fn join(table: &mut Table) -> Vec<String> {
    let mut notes = Vec::new();
    let names: Vec<String> = table.columns.iter().map(|column| simplified(&column.label())).collect();
    let mut seconds: HashMap<&str, Vec<usize>> = HashMap::new();
    for (k, name) in names.iter().enumerate() {
        for prefix in SECONDS.iter().filter_map(|ending| behind(name, ending)) {
            seconds.entry(prefix).or_default().push(k);
        }
    }
    for (fraction, name) in names.iter().enumerate() {
        let ending = FRACTIONS.iter().find_map(|(ending, unit)| Some((behind(name, ending)?, *unit)));
        let Some((prefix, unit)) = ending else { continue };
        let beside = seconds.get(prefix).map_or(&[][..], Vec::as_slice);
        let Some(seconds) = pair(table, beside, fraction) else { continue };
        let joined = stamps(&table.columns[seconds], &table.columns[fraction], unit);
        let labels = [seconds, fraction].map(|k| table.columns[k].label());
        table.columns[seconds] = joined;
        // Taken, and no signal.
        table.columns[fraction].kind = Kind::Text;
        notes.push(format!("`{}` and `{}` are one clock", labels[0], labels[1]));
    }
    notes
}

/// The first of some columns that holds the seconds of a fraction, if that is one.
fn pair(table: &Table, beside: &[usize], fraction: usize) -> Option<usize> {
    let is_number = |k: usize| table.columns[k].kind == Kind::Number;
    let is_whole =
        |k: usize| table.columns[k].values.iter().all(|value| value.is_nan() || value.fract() == 0.0);
    let fits =
        table.columns[fraction].values.iter().all(|value| value.is_nan() || (0.0..1e9).contains(value));
    if !is_number(fraction) || !fits || !is_whole(fraction) {
        return None;
    }
    beside.iter().copied().find(|k| *k != fraction && is_number(*k) && is_whole(*k))
}

/// What stands before an ending of whole words.
fn behind<'n>(name: &'n str, ending: &str) -> Option<&'n str> {
    let rest = name.strip_suffix(ending)?;
    (rest.is_empty() || rest.ends_with(' ')).then(|| rest.trim_end())
}

/// Stamps in seconds since the first, written with nine decimals.
fn stamps(seconds: &Column, fraction: &Column, unit: i128) -> Column {
    let nanoseconds = |row: usize| -> Option<i128> {
        let (whole, part) = (seconds.values[row], fraction.values[row]);
        let both = whole.is_finite() && part.is_finite();
        both.then(|| (whole as i128 + seconds.origin) * 1_000_000_000 + part as i128 * unit)
    };
    let all: Vec<Option<i128>> = (0..seconds.values.len()).map(nanoseconds).collect();
    let origin = all.iter().flatten().next().copied().unwrap_or_default();
    let value = |at: &Option<i128>| at.map_or(f64::NAN, |at| (at - origin) as f64 * 1e-9);
    let written = |at: &Option<i128>| {
        at.map_or(String::new(), |at| {
            format!("{}.{:09}", at.div_euclid(1_000_000_000), at.rem_euclid(1_000_000_000))
        })
    };
    Column {
        kind: Kind::Stamp,
        unit: None,
        origin,
        values: all.iter().map(value).collect(),
        stamps: all.iter().map(written).collect(),
        ..seconds.clone()
    }
}
