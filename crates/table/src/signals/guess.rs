//! Which column is which, where the header says so.

use super::words;
use crate::table::{Column, Kind};

/// What a column can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Time,
    Input,
    /// An input where the output is a force.
    Motion,
    /// An input where the output is a motion.
    Drive,
    /// An output where the input is such a drive.
    Answer,
    Output,
    Command,
    Response,
}

/// How surely a name says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Surety {
    /// One of its words does: `load cell force`.
    Word,
    /// The whole name does: `force`.
    Name,
}

/// The words for a part.
fn words(part: Part) -> &'static [&'static str] {
    match part {
        Part::Time => words::TIME,
        Part::Input => words::INPUT,
        Part::Motion => words::MOTION,
        Part::Drive => words::DRIVE,
        Part::Answer => words::ANSWER,
        Part::Output => words::OUTPUT,
        Part::Command => words::COMMAND,
        Part::Response => words::RESPONSE,
    }
}

/// How surely a column's name says that it is this part; none where it does not.
pub(super) fn surety(column: &Column, part: Part) -> Option<Surety> {
    let words = words(part);
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

/// Whether a column only counts the samples, perhaps anew from some on.
pub(super) fn is_index(column: &Column) -> bool {
    let name = simplified(&column.name);
    let is_named = words::INDEX.contains(&name.as_str())
        || name.starts_with("column ")
        || name.starts_with("unnamed")
        || name.split(' ').any(|word| words::COUNTER.contains(&word));
    is_named && counts(column)
}

/// Whether a column numbers the parts of a record, one after the other.
pub(super) fn is_part_number(column: &Column) -> bool {
    let is_named = simplified(&column.name).split(' ').any(|word| words::PART.contains(&word));
    let values = &column.values;
    let steps = || values.windows(2).map(|pair| pair[1] - pair[0]);
    is_named
        && steps().all(|step| step == 0.0 || step == 1.0)
        && values.iter().all(|value| value.fract() == 0.0)
}

/// Whether nine steps of ten count one sample on, all values being whole.
fn counts(column: &Column) -> bool {
    let values = &column.values;
    let steps = || values.windows(2).map(|pair| pair[1] - pair[0]);
    let ones = steps().filter(|step| *step == 1.0).count();
    column.kind == Kind::Number
        && values.len() >= 2
        && values.iter().all(|value| value.fract() == 0.0)
        && 10 * ones >= 9 * (values.len() - 1)
}

/// Whether a column holds but one value.
pub(super) fn stands_still(column: &Column) -> bool {
    let mut finite = column.values.iter().filter(|value| value.is_finite());
    let first = finite.next();
    first.is_some_and(|first| finite.all(|value| value == first))
}

/// Whether a column can be a clock: it goes on somewhere.
pub(super) fn goes_on(column: &Column) -> bool {
    let several = column.values.iter().filter(|value| value.is_finite()).count() > 1;
    column.kind != Kind::Text && !(several && stands_still(column))
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

/// The words of a name without those for a part; none where it has none of them.
pub(super) fn without(column: &Column, part: Part) -> Option<Vec<String>> {
    let name = simplified(&column.name);
    let (found, others): (Vec<&str>, Vec<&str>) =
        name.split(' ').partition(|word| words(part).contains(word));
    (!found.is_empty()).then(|| others.into_iter().map(str::to_owned).collect())
}

/// Whether a column is what a controller gives out.
pub(super) fn is_of_controller(column: &Column) -> bool {
    named(column).iter().any(|word| words::CONTROLLER.contains(&word.as_str()))
}

/// The words of a name.
pub(super) fn named(column: &Column) -> Vec<String> {
    simplified(&column.name).split(' ').map(str::to_owned).collect()
}

/// Whether a column holds the other one's signal before it was converted to a unit: `Force [V]` beside `Force [N]`.
pub(super) fn is_raw_form(column: &Column, other: &Column) -> bool {
    let is_raw_unit =
        |column: &Column| column.unit.as_deref().is_some_and(|unit| words::RAW_UNITS.contains(&unit));
    let plain = |column: &Column| -> Vec<String> {
        let name = named(column);
        name.into_iter().filter(|word| !words::RAW.contains(&word.as_str())).collect()
    };
    let has_raw_word = |column: &Column| plain(column).len() < named(column).len();
    let is_raw = |column: &Column| is_raw_unit(column) || has_raw_word(column);
    plain(column) == plain(other) && is_raw(column) && !is_raw(other)
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
    simple.split_whitespace().map(apart).collect::<Vec<_>>().join(" ")
}

/// `sollposition` as two words, where the second is one for a signal.
fn apart(word: &str) -> String {
    let is_signal = |rest: &str| {
        [words::MOTION, words::DRIVE, words::ANSWER, words::OUTPUT].iter().any(|all| all.contains(&rest))
    };
    let part = words::PREFIXES.iter().find_map(|prefix| {
        let rest = word.strip_prefix(prefix)?;
        is_signal(rest).then(|| format!("{prefix} {rest}"))
    });
    part.unwrap_or_else(|| word.to_owned())
}
