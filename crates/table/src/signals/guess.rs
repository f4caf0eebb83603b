//! Which column is which, where the header says so.

use crate::table::{Column, Kind};

/// What a column can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Time,
    Input,
    /// An input where the output is a force.
    Motion,
    Output,
}

/// How surely a name says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Surety {
    /// One of its words does: `load cell force`.
    Word,
    /// The whole name does: `force`.
    Name,
}

const TIME: &[&str] = &[
    "t",
    "time",
    "zeit",
    "timestamp",
    "datetime",
    "date",
    "elapsed",
    "seconds",
    "uhrzeit",
    "temps",
    "tiempo",
    "tempo",
    "tid",
    "x value",
];

/// What drives a machine, whatever is measured on it.
const INPUT: &[&str] =
    &["v", "u", "input", "in", "drive", "command", "cmd", "setpoint", "excitation", "eingang"];
/// Motion drives what answers with a force; but a piezo stage answers a voltage with it, so alone these words leave a doubt.
const MOTION: &[&str] = &[
    "displacement",
    "disp",
    "travel",
    "stroke",
    "position",
    "pos",
    "deflection",
    "elongation",
    "angle",
    "strain",
    "weg",
    "hub",
    "auslenkung",
    "winkel",
];
const OUTPUT: &[&str] = &[
    "y",
    "output",
    "out",
    "response",
    "ausgang",
    "force",
    "load",
    "torque",
    "moment",
    "stress",
    "kraft",
    "drehmoment",
    "spannkraft",
];
const INDEX: &[&str] =
    &["", "index", "idx", "i", "k", "n", "no", "nr", "sample", "samples", "row", "count", "id", "point"];

/// How surely a column's name says that it is this part; none where it does not.
pub(super) fn surety(column: &Column, part: Part) -> Option<Surety> {
    let words = match part {
        Part::Time => TIME,
        Part::Input => INPUT,
        Part::Motion => MOTION,
        Part::Output => OUTPUT,
    };
    let name = simplified(&column.name);
    let bare = name.trim_end_matches(|c: char| c.is_ascii_digit() || c == ' ');
    if words.contains(&name.as_str()) || words.contains(&bare) {
        return Some(Surety::Name);
    }
    // Single letters are no words of a longer name.
    name.split(' ').any(|word| word.len() > 2 && words.contains(&word)).then_some(Surety::Word)
}

/// A column that is called a time, and its first cell, where its cells are none.
pub(super) fn unread_time(column: &Column) -> Option<(String, &str)> {
    let is_text = column.kind == Kind::Text && surety(column, Part::Time).is_some();
    let first = column.faults.first().filter(|_| is_text)?;
    Some((column.label(), &first.cell))
}

/// Whether a column only counts the samples.
pub(super) fn is_index(column: &Column) -> bool {
    let name = simplified(&column.name);
    (INDEX.contains(&name.as_str()) || name.starts_with("column ") || name.starts_with("unnamed"))
        && counts(column)
}

fn counts(column: &Column) -> bool {
    let values = &column.values;
    column.kind == Kind::Number
        && values.len() >= 2
        && values[0].fract() == 0.0
        && values.windows(2).all(|pair| pair[1] - pair[0] == 1.0)
}

/// Whether a column rises in even steps, as time does: nine steps of ten within a twentieth of the median, all of them upwards.
/// Dropouts, which are looked at later, may be among the rest.
pub(super) fn is_ramp(column: &Column) -> bool {
    let finite: Vec<f64> = column.values.iter().copied().filter(|value| value.is_finite()).collect();
    let mut steps: Vec<f64> = finite.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if column.kind != Kind::Number || steps.len() < 2 || !steps.iter().all(|step| *step > 0.0) {
        return false;
    }
    steps.sort_by(f64::total_cmp);
    let median = steps[steps.len() / 2];
    let even = steps.iter().filter(|step| (**step - median).abs() <= 0.05 * median).count();
    10 * even >= 9 * steps.len()
}

/// Lower case, with single blanks for all that is neither letter nor digit, and between words joined like `loadCell`.
pub(super) fn simplified(name: &str) -> String {
    let mut simple = String::new();
    let mut before = ' ';
    for letter in name.chars() {
        if letter.is_uppercase() && before.is_lowercase() {
            simple.push(' ');
        }
        before = letter;
        simple.extend(if letter.is_alphanumeric() { letter } else { ' ' }.to_lowercase());
    }
    simple.split_whitespace().collect::<Vec<_>>().join(" ")
}
