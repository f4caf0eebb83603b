//! Sensors that stand still while the machine moves: switched off, unplugged, or stuck.

use super::plan::PlannedRecord;
use std::ops::Range;
use switchback_model::rig::Role;
use switchback_table::signals::Measured;
use switchback_table::table::{Column, Place};

/// Least share of a record, and least samples, over which a stuck sensor is distinguished from one that rests.
const LONG: f64 = 0.1;
const SAMPLES: usize = 50;
/// Share of its own range that the other signal must move over meanwhile.
const MOVES: f64 = 0.5;

/// One sentence a signal that stands still all along, or while the other one moves.
pub(super) fn warnings(record: &PlannedRecord, measured: &Measured) -> Vec<String> {
    let (Some(y), Some(output)) = (&measured.y, measured.output()) else { return Vec::new() };
    let v = &measured.v;
    let reported = |column: &Column, samples: Range<usize>, other: &str| {
        let (first, last) = (samples.start, samples.end - 1);
        let value = if std::ptr::eq(column, output) { y[first] } else { v[first] };
        let whole = if samples.len() == v.len() { ", the whole record" } else { "" };
        format!(
            "{}: `{}` stands still at {value} from {} to {}{whole}{other}: check its sensor and cable, and empty the cells where it failed, or leave the record out",
            record.named,
            column.name,
            row(measured.place(first)),
            row(measured.place(last)),
        )
    };
    let mut all = Vec::new();
    // The step experiments of the paper hold the input.
    let may_rest = matches!(record.role, Role::StepHigh | Role::StepLow);
    let input = measured.input();
    if is_constant(v) || is_constant(y) {
        if is_constant(v) && !may_rest {
            all.push(reported(input, 0..v.len(), ""));
        }
        if is_constant(y) {
            all.push(reported(output, 0..y.len(), ""));
        }
        return all;
    }
    let while_moving = |name: &str| format!(", while `{name}` moves to and fro");
    let stuck_output = longest(y, |run| !is_an_end(y, y[run.start]) && goes_to_and_fro(&v[run], v));
    all.extend(stuck_output.map(|run| reported(output, run, &while_moving(&input.name))));
    if record.role == Role::Free {
        // Once its own dynamics have died away, no output moves by itself.
        let settled = |run: &Range<usize>| run.start + run.len() / 2..run.end;
        let stuck_input = longest(v, |run| goes_to_and_fro(&y[settled(&run)], y));
        all.extend(stuck_input.map(|run| reported(input, run, &while_moving(&output.name))));
    }
    all
}

/// `line 3` or `row 3`.
fn row(place: Place) -> String {
    match place {
        Place::Line(line) => format!("line {line}"),
        Place::Row(row) => format!("row {row}"),
    }
}

fn is_constant(values: &[f64]) -> bool {
    values.len() >= 2 && values.iter().all(|x| *x == values[0])
}

/// Whether a value is where a range ends: a sensor that clips stands still there, and so does a relay.
fn is_an_end(values: &[f64], value: f64) -> bool {
    values.iter().all(|x| *x <= value) || values.iter().all(|x| *x >= value)
}

/// The longest run of equal values that is long and as asked.
fn longest(values: &[f64], is_asked: impl Fn(Range<usize>) -> bool) -> Option<Range<usize>> {
    let least = SAMPLES.max((LONG * values.len() as f64).ceil() as usize);
    let (mut start, mut found): (usize, Option<Range<usize>>) = (0, None);
    for t in 1..=values.len() {
        if t < values.len() && values[t] == values[start] {
            continue;
        }
        let run = start..t;
        let longer = found.as_ref().is_none_or(|other| run.len() > other.len());
        if run.len() >= least && longer && is_asked(run.clone()) {
            found = Some(run);
        }
        start = t;
    }
    found
}

/// Whether a stretch of a signal both rises and falls by a good share of the whole signal's range.
fn goes_to_and_fro(stretch: &[f64], whole: &[f64]) -> bool {
    let ends = |values: &[f64]| {
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)))
    };
    let (low, high) = ends(whole);
    let far = MOVES * (high - low);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut rises, mut falls) = (false, false);
    for &x in stretch {
        rises |= x - least > far;
        falls |= most - x > far;
        (least, most) = (least.min(x), most.max(x));
    }
    rises && falls
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_run_that_is_long_and_as_asked_is_found() {
        let moving = |t: usize| (0.1 * t as f64).sin();
        let mut values: Vec<f64> = (0..1000).map(moving).collect();
        assert_eq!(longest(&values, |_| true), None);
        values[300..520].fill(0.25);
        values[700..760].fill(0.3);
        assert_eq!(longest(&values, |_| true), Some(300..520));
        assert_eq!(longest(&values, |run| run.start > 600), None, "60 of 1000 samples may be a rest");
    }

    #[test]
    fn to_and_fro_is_more_than_there() {
        let ramp: Vec<f64> = (0..100).map(f64::from).collect();
        let back: Vec<f64> = ramp.iter().chain(ramp.iter().rev()).copied().collect();
        assert!(!goes_to_and_fro(&ramp, &ramp) && goes_to_and_fro(&back, &back));
        assert!(!goes_to_and_fro(&back[80..120], &back), "a fifth of the range is a wobble");
    }
}
