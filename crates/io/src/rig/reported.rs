//! What was inferred, in a few lines.

use super::divided::Divided;
use super::doubts;
use super::plan::{HELD_OUT, Plan};
use super::quantity::of_predictions;
use std::fmt::{self, Display};
use switchback_model::rig::Usage;
use switchback_table::signals::{Between, ClockSource, InputForm, Measured, Resampled, rounded, spikes};
use switchback_table::table::{Column, Place};

/// What was inferred from the files rather than said by the user. Shown as lines, none where nothing was.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Reported {
    /// Which columns were taken.
    pub columns: Option<String>,
    /// The sample time, where it comes from, and what interrupts it.
    pub sample_time: Option<String>,
    /// What is held out.
    pub held_out: Option<String>,
    /// Values that cannot have been measured, and records that are unlikely to be what they are declared.
    pub warnings: Vec<String>,
    /// How unusual files were read.
    pub notes: Vec<String>,
}

impl Display for Reported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for warning in &self.warnings {
            writeln!(f, "warning: {warning}")?;
        }
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        let named =
            [("columns", &self.columns), ("sample time", &self.sample_time), ("held out", &self.held_out)];
        for (name, line) in named {
            if let Some(line) = line {
                writeln!(f, "{name}: {line}")?;
            }
        }
        Ok(())
    }
}

pub(super) fn describe(plan: &Plan, divided: &[Divided]) -> Reported {
    let first = &divided[0].measured;
    let is_line = plan.input_form != InputForm::Manifest;
    let is_usual = plan.columns.input.is_some() && plan.columns.output.is_some() || has_usual_names(first);
    let interruptions: Vec<String> = divided.iter().filter_map(dropouts).collect();
    let timed = is_line
        || plan.sampling.sample_time.is_none()
        || !interruptions.is_empty()
        || plan.sampling.resample.is_some();
    Reported {
        columns: (is_line || !is_usual).then(|| columns(plan, first) + &other_columns(divided)),
        sample_time: timed.then(|| {
            std::iter::once(sample_time(divided)).chain(interruptions).collect::<Vec<_>>().join("; ")
        }),
        held_out: is_line.then(|| held_out(plan, divided)),
        warnings: divided
            .iter()
            .flat_map(|Divided { measured, .. }| measured.doubts.iter().cloned().chain(spikes(measured)))
            .chain(doubts::warnings(plan, divided))
            .collect(),
        notes: notes(divided),
    }
}

/// The names that rig files always used.
fn has_usual_names(measured: &Measured) -> bool {
    let is = |column: Option<&Column>, name: &str| column.is_some_and(|column| column.name == name);
    is(Some(measured.input()), "v") && is(measured.output(), "y")
}

/// Files that read alike share a line.
fn notes(divided: &[Divided]) -> Vec<String> {
    let mut lines: Vec<(String, Vec<&str>)> = Vec::new();
    for Divided { measured, .. } in divided.iter().filter(|divided| !divided.measured.table.notes.is_empty())
    {
        let note = measured.table.notes.join(", ");
        match lines.iter_mut().find(|(other, _)| *other == note) {
            Some((_, files)) => files.push(&measured.table.path),
            None => lines.push((note, vec![&measured.table.path])),
        }
    }
    lines.into_iter().map(|(note, files)| format!("{}: {note}", files.join(", "))).collect()
}

fn columns(plan: &Plan, first: &Measured) -> String {
    let table = &first.table;
    let label = |k: usize| {
        if table.has_header { format!("`{}`", table.columns[k].label()) } else { format!("{}", k + 1) }
    };
    let selection = &first.selection;
    let mut parts = vec![format!("input {}", label(selection.input))];
    parts.extend(selection.output.map(|k| format!("output {}", label(k))));
    parts.extend(selection.time.map(|k| format!("time {}", label(k))));
    let converted = match (of_predictions(first), first.output().and_then(|output| output.unit.as_deref())) {
        (Some(_), Some(unit)) => format!(" (converted to {unit})"),
        _ => String::new(),
    };
    parts.extend(selection.prediction.map(|k| format!("prediction {}{converted}", label(k))));
    let mut line = parts.join(", ");
    if !selection.rivals.is_empty() {
        let rivals: Vec<String> = selection.rivals.iter().map(|&k| label(k)).collect();
        let how = plan.input_form.other_column();
        line += &format!("; there {} also {} (take another by {how})", are(rivals.len()), rivals.join(", "));
    }
    line
}

/// Files whose columns are called otherwise than the first's.
fn other_columns(divided: &[Divided]) -> String {
    let named = |measured: &Measured| {
        [Some(measured.input()), measured.output()].map(|column| column.map(Column::label))
    };
    let first = named(&divided[0].measured);
    let others = divided.iter().map(|divided| &divided.measured).filter(|measured| named(measured) != first);
    let reported = others.map(|measured| {
        let [input, output] = named(measured).map(Option::unwrap_or_default);
        format!("; in {} input `{input}`, output `{output}`", measured.table.path)
    });
    reported.collect()
}

fn are(count: usize) -> &'static str {
    if count == 1 { "is" } else { "are" }
}

fn sample_time(divided: &[Divided]) -> String {
    let first = &divided[0].measured;
    let step = first.sample_time;
    let mut line = format!("{} s ({} Hz)", rounded(step), short(1.0 / step));
    match &first.source {
        ClockSource::Given => line += ", as given",
        ClockSource::Stated => line += ", as stated above the table",
        ClockSource::Counted => line += ", from the time column and the column that counts the samples",
        ClockSource::GivenAndTime => line += ", as given; the time column agrees",
        ClockSource::Time { .. } => line += ", from the time column",
        ClockSource::Resampled(Resampled { between: Between::Linear, .. }) => {
            line += ", to which the rows were interpolated";
        }
        ClockSource::Resampled(Resampled { between: Between::Hold, .. }) => {
            line += ", at which the last rows are held";
        }
    }
    let jitter = divided.iter().filter_map(|divided| match divided.measured.source {
        ClockSource::Time { jitter } => Some(jitter),
        _ => None,
    });
    let jitter = jitter.fold(0.0, f64::max);
    // Less than this is rounding of printed stamps.
    if jitter > 1e-4 {
        line += &format!(", whose steps differ from it by up to {:.2} %", 100.0 * jitter);
    }
    let longest = divided.iter().filter_map(|divided| match divided.measured.source {
        ClockSource::Resampled(reported) => Some(reported.longest),
        _ => None,
    });
    if let Some(longest) = longest.reduce(f64::max) {
        let how = match &first.source {
            ClockSource::Resampled(Resampled { between: Between::Hold, .. }) => "",
            _ => " linearly",
        };
        line += &format!("{how}; the longest step bridged is {} s", short(longest));
    }
    line
}

/// What interrupts a record.
fn dropouts(divided: &Divided) -> Option<String> {
    let Divided { measured, parts } = divided;
    let count = measured.pieces.len().checked_sub(1).filter(|count| *count > 0)?;
    let error = measured.first_interruption()?;
    let place = match error.place {
        Some(Place::Line(line)) => format!("{}:{line}", error.path),
        Some(Place::Row(row)) => format!("{}, row {row}", error.path),
        None => error.path,
    };
    let used: usize = parts.iter().map(|part| part.range.len()).sum();
    let all: usize = measured.pieces.iter().map(std::ops::Range::len).sum();
    let anew = measured.starts_anew();
    let split = match count {
        _ if anew == count => return None,
        1 => format!("a dropout at {place} splits the record in two"),
        _ => format!("{count} dropouts, the first at {place}, split the record into {} pieces", count + 1),
    };
    Some(match all - used {
        0 => split,
        lost => format!("{split}; {lost} samples in pieces too short to be used are left out"),
    })
}

fn held_out(plan: &Plan, divided: &[Divided]) -> String {
    let mut reported = Vec::new();
    for (record, Divided { measured, parts }) in plan.records.iter().zip(divided) {
        let held: Vec<_> = parts.iter().filter(|part| part.usage == Usage::Holdout).collect();
        let samples: usize = held.iter().map(|part| part.range.len()).sum();
        let all: usize = parts.iter().map(|part| part.range.len()).sum();
        match (held.first(), record.held_out) {
            (Some(first), Some(share)) => {
                let share = if share == HELD_OUT {
                    "third".to_owned()
                } else {
                    format!("{} %", short(100.0 * share))
                };
                let place = match measured.place(first.range.start) {
                    Place::Line(line) => format!("line {line}"),
                    Place::Row(row) => format!("row {row}"),
                };
                reported.push(format!(
                    "the last {share} of {} ({samples} of {all} samples, from {place} on)",
                    record.named
                ));
            }
            (Some(_), None) => reported.push(format!("{} ({samples} samples)", record.named)),
            _ => {}
        }
    }
    match reported.is_empty() {
        true => "nothing".to_owned(),
        false => format!("{}; {} changes it", reported.join(", "), plan.input_form.other_holdout()),
    }
}

/// The same of files of which only the number of samples is known.
pub(super) fn held_out_of(plan: &Plan, samples: &[usize]) -> String {
    let reported = plan.records.iter().zip(samples).filter_map(|(record, all)| match record.held_out {
        Some(share) => {
            let part =
                if share == HELD_OUT { "third".to_owned() } else { format!("{} %", short(100.0 * share)) };
            let held = (share * *all as f64).round();
            Some(format!("the last {part} of {} (about {held} of {all} samples)", record.named))
        }
        None => (record.usage == Usage::Holdout).then(|| format!("{} ({all} samples)", record.named)),
    });
    let reported: Vec<String> = reported.collect();
    match reported.is_empty() {
        true => "nothing".to_owned(),
        false => format!("{}; {} changes it", reported.join(", "), plan.input_form.other_holdout()),
    }
}

fn short(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
