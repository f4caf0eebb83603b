//! Which column is which, where the header says so.

use super::spelling::{last_part, simplified};
use super::words::{self, Words};
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
fn words(part: Part) -> Words {
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
    if words::has(words, &name) || words::has(words, bare) {
        return Some(Surety::Name);
    }
    // Single letters are no words of a longer name.
    name.split(' ').any(|word| word.len() > 2 && words::has(words, word)).then_some(Surety::Word)
}

/// A column that is called a time, and its first cell, where its cells are none. Of a date and a time of day it is the one that changes more
/// often, and a date that stands still is none.
pub(super) fn unread_time(columns: &[Column]) -> Option<(String, &str)> {
    let is_text = |column: &&Column| {
        column.kind == Kind::Text && column.words.len() > 1 && surety(column, Part::Time).is_some()
    };
    let unread = columns.iter().filter(is_text).min_by_key(|column| std::cmp::Reverse(column.words.len()))?;
    Some((unread.label(), &unread.faults.first()?.cell))
}

/// Whether a column only counts the samples, perhaps anew from some on.
pub(super) fn is_index(column: &Column) -> bool {
    let name = simplified(&column.name);
    let is_named = name.is_empty()
        || words::has(words::INDEX, &name)
        || name.starts_with("column ")
        || name.starts_with("unnamed")
        || name.split(' ').any(|word| words::has(words::COUNTER, word));
    is_named && counts(column)
}

/// Whether a column numbers the parts of a record, one after the other, or rises evenly through them.
pub(super) fn is_part_number(column: &Column) -> bool {
    let is_named = named(column).iter().any(|word| words::has(words::PART, word));
    let finite: Vec<f64> = column.values.iter().copied().filter(|value| value.is_finite()).collect();
    let mut steps = finite.windows(2).map(|pair| pair[1] - pair[0]);
    let is_whole = || finite.iter().all(|value| value.fract() == 0.0);
    is_named
        && (is_whole() && steps.all(|step| step == 0.0 || step == 1.0)
            || is_ramp(column) && quantity(column) == Quantity::Unknown)
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

/// At how many rows a column differs from the one before.
pub(super) fn changes(column: &Column) -> usize {
    column.values.windows(2).filter(|pair| pair[0] != pair[1]).count()
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

/// Whether a column goes on as time does: at most one of ten steps goes back, as where another record begins.
pub(super) fn increases(column: &Column) -> bool {
    let finite: Vec<f64> = column.values.iter().copied().filter(|value| value.is_finite()).collect();
    let back = finite.windows(2).filter(|pair| pair[1] < pair[0]).count();
    10 * back < finite.len()
}

/// Whether a column says how long something takes, by its own name: `turnaroundTime`, but not `Cycle Elapsed Time`.
pub(super) fn is_duration(column: &Column) -> bool {
    let own = simplified(last_part(&column.name));
    let has = |list: Words| own.split(' ').any(|word| words::has(list, word));
    has(words::DURATION) && has(words::DURATION_OF) && !has(&["elapsed, total"])
}

/// The words of a name without those for a part; none where it has none of them.
pub(super) fn without(column: &Column, part: Part) -> Option<Vec<String>> {
    let name = simplified(&column.name);
    let (found, others): (Vec<&str>, Vec<&str>) =
        name.split(' ').partition(|word| words::has(words(part), word));
    (!found.is_empty()).then(|| others.into_iter().map(str::to_owned).collect())
}

/// Whether a column is what a controller gives out: by its own name, not by where it was logged.
pub(super) fn is_of_controller(column: &Column) -> bool {
    simplified(last_part(&column.name)).split(' ').any(|word| words::has(words::CONTROLLER, word))
}

/// Whether a column says where a machine should be, by its own name.
pub(super) fn is_reference(column: &Column) -> bool {
    simplified(last_part(&column.name)).split(' ').any(|word| words::has(words::REFERENCE, word))
}

/// What a signal is, by its words, else by its unit; commands of a place come before those of a speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Quantity {
    Place,
    Unknown,
    Speed,
    Effort,
}

impl Quantity {
    /// In words.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Place => "position",
            Self::Unknown => "signal",
            Self::Speed => "speed",
            Self::Effort => "force or current",
        }
    }
}

/// What a signal is.
pub(super) fn quantity(column: &Column) -> Quantity {
    let own = simplified(last_part(&column.name));
    let has = |lists: &[Words]| {
        let mut own = own.split(' ').map(|word| word.trim_end_matches(|c: char| c.is_ascii_digit()));
        own.any(|word| lists.iter().any(|list| words::has(list, word)))
    };
    let unit = column.unit.as_deref().unwrap_or_default();
    let is_effort = || has(&[words::OUTPUT, words::DRIVE, words::EFFORT]) && own != "y" && own != "out";
    match () {
        () if has(&[words::SPEED, words::ANSWER]) => Quantity::Speed,
        () if has(&[words::MOTION]) => Quantity::Place,
        () if is_effort() => Quantity::Effort,
        () if has(&[words::PLACE]) || words::has(words::UNITS_OF_MOTION, unit) => Quantity::Place,
        () if words::has(words::UNITS_OF_SPEED, unit) => Quantity::Speed,
        () if words::has(words::UNITS_OF_FORCE, unit) || words::has(words::UNITS_OF_FEED, unit) => {
            Quantity::Effort
        }
        () => Quantity::Unknown,
    }
}

/// Whether a column is a travel of machines that load specimens, rather than a position of any machine.
pub(super) fn is_of_testing_machine(column: &Column) -> bool {
    named(column).iter().any(|word| words::has(words::TEST_TRAVEL, word))
}

/// Whether a column is a force or torque that was measured: in such a unit, or called so.
pub(super) fn is_force(column: &Column) -> bool {
    let own = simplified(last_part(&column.name));
    let is_called = own.split(' ').any(|word| words::has(words::FORCE, word));
    let is_meant = if column.unit.is_some() { is_in(column, words::UNITS_OF_FORCE) } else { is_called };
    is_meant && surety(column, Part::Command).is_none() && !is_deviation(column)
}

/// Whether a column is in a unit of this list.
pub(super) fn is_in(column: &Column, units: Words) -> bool {
    column.unit.as_deref().is_some_and(|unit| words::has(units, unit))
}

/// Whether a column is what a sensor or a machine is fed with, which hardly moves.
pub(super) fn is_feed(column: &Column) -> bool {
    /// Standard deviation of a supply, as a share of its mean.
    const RIPPLE: f64 = 0.05;
    let is_named = named(column).iter().any(|word| words::has(words::FEED, word));
    let is_electric = column.unit.is_none() || is_in(column, words::UNITS_OF_FEED);
    let finite: Vec<f64> = column.values.iter().copied().filter(|value| value.is_finite()).collect();
    let count = finite.len().max(1) as f64;
    let mean = finite.iter().sum::<f64>() / count;
    let variance = finite.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    is_named && is_electric && variance.sqrt() < RIPPLE * mean.abs()
}

/// Whether a column is what a controller computes from others, by its name.
pub(super) fn is_deviation(column: &Column) -> bool {
    let own = simplified(last_part(&column.name));
    own.split(' ').any(|word| words::has(words::DEVIATION, word))
}

/// Whether a column is called as a term of a controller, and nothing else.
pub(super) fn is_term(column: &Column) -> bool {
    column.unit.is_none() && words::has(words::TERM, &simplified(last_part(&column.name)))
}

/// The words of a name.
pub(super) fn named(column: &Column) -> Vec<String> {
    simplified(&column.name).split(' ').map(str::to_owned).collect()
}

/// The words of a name without those for a signal before it was converted to a unit, and whether the column holds that: `Force [V]` beside
/// `Force [N]`.
pub(super) fn plain_form(column: &Column) -> (Vec<String>, bool) {
    let name = named(column);
    let plain: Vec<String> = name.iter().filter(|word| !words::has(words::RAW, word)).cloned().collect();
    let is_raw = is_in(column, words::RAW_UNITS) || plain.len() < name.len();
    (plain, is_raw)
}
