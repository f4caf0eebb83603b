//! Signals that were logged at rates of their own: cells left blank or held between, rows of their own, clocks of their own.

use super::causality::error_with;
use super::clock::Clock;
use super::guess::{self, Part};
use super::input_form::InputForm;
use super::names::Between;
use super::select::Selection;
use crate::table::{Column, Kind, Table};

/// Share of the rows with an output that must lack an input before that has a rate of its own: less is a sensor that failed now and then.
const SPARSE: f64 = 0.5;
/// Rows between two values of a slow signal, in units of their usual distance, that are no gap.
const BRIDGED: f64 = 3.5;
/// Rows for which a held value lasts at least, and changes that show it.
const LEAST_HELD: usize = 3;
const LEAST_CHANGES: usize = 30;
/// Held values predict the output better than straight lines where they leave less than this share of the error.
const CLEARLY_BETTER: f64 = 0.9;

/// Brings input and output to the same rows, those of the output, and says how.
pub(super) fn join(
    table: &mut Table,
    selection: &mut Selection,
    (between, is_time_given): (Option<Between>, bool),
) -> Vec<String> {
    let Some(output) = selection.output else { return Vec::new() };
    let mut notes = Vec::new();
    // A clock that the user named is that of all signals, unless it is the output's own.
    if !is_time_given || selection.time == clock_of(table, output) {
        notes.extend(by_clocks(table, selection, output, between));
    }
    let filled = blanks(table, selection, output, between);
    if filled.is_none() {
        notes.extend(held_output(table, selection, output));
        notes.extend(held_input(table, selection, output, between));
    }
    notes.extend(filled);
    notes
}

/// Times and values of a signal where it has both.
struct Points {
    t: Vec<f64>,
    x: Vec<f64>,
}

impl Points {
    fn of(t: &[f64], x: &[f64]) -> Self {
        let both = t.iter().zip(x).filter(|(t, x)| t.is_finite() && x.is_finite());
        let (mut points, mut last) = (Self { t: Vec::new(), x: Vec::new() }, f64::NEG_INFINITY);
        for (t, x) in both.filter(|(t, _)| {
            let is_later = **t > last;
            last = last.max(**t);
            is_later
        }) {
            points.t.push(*t);
            points.x.push(*x);
        }
        points
    }

    /// The usual distance between two points.
    fn step(&self) -> Option<f64> {
        let mut steps: Vec<f64> = self.t.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied()
    }

    /// The values at other times; none beyond the ends, nor within gaps longer than `longest`.
    fn at(&self, times: &[f64], longest: f64, between: Between) -> Vec<f64> {
        let value = |t: &f64| {
            let right = self.t.partition_point(|own| own <= t);
            let left = right.checked_sub(1)?;
            if self.t[left] == *t {
                return Some(self.x[left]);
            }
            let next = *self.t.get(right)?;
            if next - self.t[left] > longest {
                return None;
            }
            let share = (t - self.t[left]) / (next - self.t[left]);
            Some(match between {
                Between::Hold => self.x[left],
                Between::Linear => self.x[left] + share * (self.x[right] - self.x[left]),
            })
        };
        times.iter().map(|t| if t.is_finite() { value(t).unwrap_or(f64::NAN) } else { f64::NAN }).collect()
    }

    /// By how much straight lines between the points are off, about: a line over a point from its neighbours, which are twice as far apart, is
    /// off four times as much where the signal is smooth.
    fn unknown(&self) -> f64 {
        let off = |k: usize| self.x[k] - 0.5 * (self.x[k - 1] + self.x[k + 1]);
        let inner = 1..self.x.len().saturating_sub(1);
        let count = inner.len().max(1) as f64;
        0.25 * (inner.map(|k| off(k).powi(2)).sum::<f64>() / count).sqrt()
    }

    /// The values at other times, held or interpolated: as asked, else by whatever predicts the output better.
    fn joined(
        &self,
        times: &[f64],
        longest: f64,
        (asked, y): (Option<Between>, &[f64]),
    ) -> (Vec<f64>, Between) {
        let of = |between| self.at(times, longest, between);
        if let Some(between) = asked {
            return (of(between), between);
        }
        let (held, straight) = (of(Between::Hold), of(Between::Linear));
        match is_better(&held, &straight, (y, CLEARLY_BETTER)) {
            true => (held, Between::Hold),
            false => (straight, Between::Linear),
        }
    }
}

/// Whether one input leaves less than a share of the error of predicting the output that another leaves.
fn is_better(one: &[f64], other: &[f64], (y, share): (&[f64], f64)) -> bool {
    let rows: Vec<usize> = (0..y.len())
        .filter(|&row| one[row].is_finite() && other[row].is_finite() && y[row].is_finite())
        .collect();
    let of = |signal: &[f64]| -> Vec<f64> { rows.iter().map(|&row| signal[row]).collect() };
    let y = of(y);
    match (error_with(&y, &of(one)), error_with(&y, &of(other))) {
        (Some(one), Some(other)) => one < share * other,
        _ => false,
    }
}

/// Seconds of a clock, from an instant that two of them share.
fn seconds(column: &Column, origin: i128) -> Vec<f64> {
    let raw: Vec<f64> = column.values.iter().copied().filter(|t| t.is_finite()).collect();
    let clock = Clock::of(column, &raw, &InputForm::Manifest).ok().map(|clock| clock.counting(&raw, None));
    let scale = clock.as_ref().map_or(1.0, |clock| clock.unit);
    let ahead = (column.origin - origin) as f64 * if column.kind == Kind::Stamp { 1e-9 } else { scale };
    let seconds = |t: &f64| clock.as_ref().map_or(*t, |clock| clock.shared_seconds(*t)) + ahead;
    column.values.iter().map(seconds).collect()
}

/// The clock that stands before a signal, the nearest of several.
fn clock_of(table: &Table, signal: usize) -> Option<usize> {
    let is_clock = |k: &usize| {
        let column = &table.columns[*k];
        guess::goes_on(column) && guess::surety(column, Part::Time).is_some() && !guess::is_index(column)
    };
    let clocks = || (0..table.columns.len()).filter(is_clock);
    clocks().rfind(|k| *k < signal).or_else(|| clocks().find(|k| *k > signal))
}

/// Joins signals with clocks of their own.
fn by_clocks(
    table: &mut Table,
    selection: &mut Selection,
    output: usize,
    between: Option<Between>,
) -> Option<String> {
    let (own, others) = (clock_of(table, selection.input)?, clock_of(table, output)?);
    [own, others].into_iter().for_each(|clock| table.columns[clock].exact());
    let origin = table.columns[others].origin;
    let is_same =
        origin == table.columns[own].origin && table.columns[own].values == table.columns[others].values;
    if own == others || is_same {
        return None;
    }
    let (t, times) = (seconds(&table.columns[own], origin), seconds(&table.columns[others], origin));
    let points = Points::of(&t, &table.columns[selection.input].values);
    let there = Points::of(&times, &table.columns[output].values);
    let (step, slow) = (points.step()?, there.step()?);
    let longest = BRIDGED * step.max(slow);
    let y = &table.columns[output].values;
    let (values, how) = points.joined(&times, longest, (between.or(Some(Between::Linear)), y));
    if !values.iter().zip(y).any(|(v, y)| v.is_finite() && y.is_finite()) {
        return None;
    }
    table.columns[selection.input].values = values;
    selection.time = Some(others);
    let label = |k: usize| format!("`{}`", table.columns[k].label());
    Some(format!(
        "{} has a clock of its own, {}, and {} Hz; {} has {} and {} Hz: joined on time, the input {} at the times of the output",
        label(selection.input),
        label(own),
        rate(step),
        label(output),
        label(others),
        rate(slow),
        verb(how)
    ))
}

fn verb(between: Between) -> &'static str {
    match between {
        Between::Hold => "held",
        Between::Linear => "interpolated linearly",
    }
}

fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

fn rate(step: f64) -> f64 {
    format!("{:.3e}", 1.0 / step).parse().unwrap_or(f64::NAN)
}

/// Times of the rows, by the clock or by their number.
fn times(table: &Table, time: Option<usize>) -> Vec<f64> {
    match time.map(|k| &table.columns[k]) {
        Some(clock) => seconds(clock, clock.origin),
        None => (0..table.places.len()).map(|row| row as f64).collect(),
    }
}

/// Fills an input with blanks between its values.
fn blanks(
    table: &mut Table,
    selection: &Selection,
    output: usize,
    between: Option<Between>,
) -> Option<String> {
    let (v, y) = (&table.columns[selection.input].values, &table.columns[output].values);
    let outputs = y.iter().filter(|y| y.is_finite()).count();
    let inputs = v.iter().filter(|v| v.is_finite()).count();
    let both = v.iter().zip(y).filter(|(v, y)| v.is_finite() && y.is_finite()).count();
    let t = times(table, selection.time);
    let (own, there) = (Points::of(&t, v), Points::of(&t, y));
    let (step, slow) = (own.step()?, there.step()?);
    let label = |k: usize| format!("`{}`", table.columns[k].label());
    let rates = |how: &str| match selection.time {
        Some(_) => format!(
            "{} at {} Hz, {} at {} Hz: {how}",
            label(selection.input),
            rate(step),
            label(output),
            rate(slow)
        ),
        None => format!("{} in {inputs} rows, {} in {outputs}: {how}", label(selection.input), label(output)),
    };
    if inputs < 2 || outputs < 2 {
        return None;
    }
    if (both as f64) >= (1.0 - SPARSE) * outputs as f64 {
        let is_slow = (both as f64) < (1.0 - SPARSE) * inputs as f64;
        return is_slow.then(|| rates("the rows with an output are taken"));
    }
    // A value that stands wherever it changed, and only there, is held between.
    let is_changes_only = own.x.windows(2).all(|pair| pair[0] != pair[1]) && uneven(&own.t, step);
    // Signals of one rate that a logger wrote one after the other were sampled together: a line between two inputs would come too early.
    let is_paired = (step - slow).abs() <= 0.05 * slow;
    let asked = between.or((is_changes_only || is_paired).then_some(Between::Hold));
    let longest = if is_changes_only { f64::INFINITY } else { BRIDGED * step.max(slow) };
    let (values, how) = own.joined(&t, longest, (asked, y));
    let unknown = match how {
        Between::Linear => format!(
            ", which is off by about {}: what moves the input by less cannot be seen",
            two_digits(own.unknown())
        ),
        Between::Hold => String::new(),
    };
    let note = rates(&format!("the input is {} between its values{unknown}", verb(how)));
    // Rows of the input alone are no samples any more.
    let is_sample = y.iter().map(|y| y.is_finite());
    let values = values.into_iter().zip(is_sample).map(|(v, is)| if is { v } else { f64::NAN }).collect();
    table.columns[selection.input].values = values;
    Some(note)
}

/// Whether the distances between points differ widely.
fn uneven(t: &[f64], step: f64) -> bool {
    let odd = t.windows(2).filter(|pair| (pair[1] - pair[0] - step).abs() > 0.5 * step).count();
    10 * odd > t.len()
}

/// Every how many rows a signal changes, and at which of them, where all changes show that.
fn held(values: &[f64]) -> Option<(usize, usize)> {
    let changes: Vec<usize> =
        (1..values.len()).filter(|&row| values[row] != values[row - 1] && values[row].is_finite()).collect();
    let mut steps: Vec<usize> = changes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.len() < LEAST_CHANGES {
        return None;
    }
    steps.sort_unstable();
    let every = steps[steps.len() / 20].max(1);
    let phase = changes[changes.len() / 2] % every;
    let in_phase = changes.iter().filter(|row| **row % every == phase).count();
    let is_usual = steps.iter().filter(|step| **step == every).count();
    (every >= LEAST_HELD && 50 * in_phase >= 49 * changes.len() && 2 * is_usual >= steps.len())
        .then_some((every, phase))
}

/// An output that changes at every tenth row only has a tenth of the samples.
fn held_output(table: &mut Table, selection: &Selection, output: usize) -> Option<String> {
    // Without a clock the rows are the samples.
    selection.time?;
    let (every, phase) = held(&table.columns[output].values)?;
    let step = Points::of(&times(table, selection.time), &table.columns[output].values).step()?;
    let at = rate(step * every as f64);
    let column = &mut table.columns[output];
    let label = column.label();
    column
        .values
        .iter_mut()
        .enumerate()
        .filter(|(row, _)| row % every != phase)
        .for_each(|(_, value)| *value = f64::NAN);
    Some(format!("`{label}` changes at every {every}th row only, at {at} Hz: the rows between are left out"))
}

/// An input that changes at every tenth row was held there by the machine or by the logger: the output shows which.
fn held_input(
    table: &mut Table,
    selection: &Selection,
    output: usize,
    between: Option<Between>,
) -> Option<String> {
    let v = &table.columns[selection.input].values;
    let (every, phase) = held(v)?;
    let y = &table.columns[output].values;
    if y.iter().filter(|y| y.is_finite()).count() * 2 < v.len() {
        // The output is as slow, and the rows between are out already.
        return None;
    }
    let rows: Vec<f64> = (0..v.len()).map(|row| row as f64).collect();
    let knots: Vec<f64> =
        (0..v.len()).map(|row| if row % every == phase { v[row] } else { f64::NAN }).collect();
    let points = Points::of(&rows, &knots);
    let straight = points.at(&rows, BRIDGED * every as f64, Between::Linear);
    let is_straight = match between {
        Some(between) => between == Between::Linear,
        None => is_better(&straight, v, (y, 1.0)),
    };
    let label = table.columns[selection.input].label();
    let step = Points::of(&times(table, selection.time), y).step()?;
    let at = selection.time.map_or(String::new(), |_| format!(", at {} Hz", rate(step * every as f64)));
    let how = if is_straight {
        table.columns[selection.input].values = straight;
        format!(
            "interpolated linearly between, which predicts the output better (`--resample hold` keeps the steps) but is off by about {}: what \
             moves the input by less cannot be seen",
            two_digits(points.unknown())
        )
    } else {
        "taken as held between (`--resample linear` interpolates)".to_owned()
    };
    Some(format!("`{label}` changes at every {every}th row only{at}: {how}"))
}
