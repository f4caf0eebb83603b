//! Records that can be read and are no likely measurements of the system that is declared.

use super::divided::Divided;
use super::plan::{Plan, PlannedRecord};
use super::{plausibility, run_state};
use switchback_model::hysteresis::Interval;
use switchback_model::rig::Usage;
use switchback_table::signals::Measured;
use switchback_table::table::Place;

/// One sentence a doubt.
pub(super) fn warnings(plan: &Plan, divided: &[Divided]) -> Vec<String> {
    let records = || plan.records.iter().zip(divided.iter().map(|divided| &divided.measured));
    let fitted: Vec<&Measured> =
        records().filter(|(record, _)| record.usage == Usage::Fit).map(|(_, measured)| measured).collect();
    let outside = plan.interval.into_iter().flat_map(|interval| {
        records().filter_map(move |(record, measured)| far_outside(record, measured, interval))
    });
    let all: Vec<(&PlannedRecord, &Measured)> = records().collect();
    let still = records().flat_map(|(record, measured)| run_state::warnings(record, measured));
    let unlikely = plausibility::warnings(&all);
    copies(&all).into_iter().chain(still).chain(outside).chain(one_way(&fitted)).chain(unlikely).collect()
}

/// Samples under two names, by a link or a copy, of which one is fitted and the other held out.
fn copies(records: &[(&PlannedRecord, &Measured)]) -> Vec<String> {
    let mut reported = Vec::new();
    for (k, (record, measured)) in records.iter().enumerate() {
        let is_copy = |(other, theirs): &&(&PlannedRecord, &Measured)| {
            other.usage != record.usage && theirs.v == measured.v && theirs.y == measured.y
        };
        if let Some((other, _)) = records[..k].iter().find(is_copy) {
            reported.push(format!(
                "{} holds the same samples as {}: a hold-out that is also fitted proves nothing, give another record",
                record.named, other.named
            ));
        }
    }
    reported
}

/// The input leaves the declared interval by more than that is wide, which no tolerance explains.
fn far_outside(record: &PlannedRecord, measured: &Measured, interval: Interval) -> Option<String> {
    let (low, high) = (interval.low(), interval.high());
    let is_far = |v: &f64| *v < low - (high - low) || *v > high + (high - low);
    let first = measured.v.iter().position(is_far)?;
    let count = measured.v.iter().filter(|v| is_far(v)).count();
    let place = match measured.place(first) {
        Place::Line(line) => format!("{}:{line}", record.named),
        Place::Row(row) => format!("{}, row {row}", record.named),
    };
    Some(format!(
        "{place}: `{}` is {}, far outside the declared interval [{low}, {high}], in {count} of {} samples: check its unit, or correct `interval`",
        measured.input().name,
        measured.v[first],
        measured.v.len()
    ))
}

/// An input that only rises, or only falls, in all that is fitted visits one border.
fn one_way(fitted: &[&Measured]) -> Option<String> {
    let steps = || fitted.iter().flat_map(|measured| measured.v.windows(2).map(|pair| pair[1] - pair[0]));
    let (rises, falls) = (steps().any(|step| step > 0.0), steps().any(|step| step < 0.0));
    let (does, missing) = match (rises, falls) {
        (true, false) => ("rises", "falls"),
        (false, true) => ("falls", "rises"),
        _ => return None,
    };
    let name = &fitted.first()?.input().name;
    Some(format!(
        "`{name}` only {does} in all that is fitted, so that one border is never seen: fit to a record in which it {missing} too"
    ))
}
