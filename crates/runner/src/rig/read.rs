//! From a rig file to a [`Plan`], and from that to a [`Rig`].

use super::assemble::{Loaded, Located, assemble};
use super::plan::{ColumnNames, Plan, PlannedRecord, Sampling};
use super::problem::{RigError, RigProblem};
use super::voice::Voice;
use super::wire::{WireColumns, WireRecord, WireRig};
use crate::input::{DataProblem, FileError, TomlError, TomlFile};
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Component, Path};
use switchback_estimator::hysteresis::Interval;
use switchback_estimator::rig::{Rig, Usage};
use toml::Spanned;

/// Highest order that a rig file may ask for; beyond it the coefficients drown in rounding errors.
const MAX_ORDER: i64 = 20;

/// Reads a rig file and the files of measurements it names, which lie relative to its folder.
///
/// # Errors
/// [`RigError`] with all that is wrong in the rig file, or where nothing is, with all that is wrong in its records.
pub fn read(path: &Path) -> Result<Rig, RigError> {
    Ok(load(path)?.rig)
}

/// The same, with what was inferred on the way.
///
/// # Errors
/// As [`read`].
pub fn load(path: &Path) -> Result<Loaded, RigError> {
    let file = TomlFile::read(path)?;
    let (plan, spans) = plan(&file)
        .map_err(|problems| RigError::new(problems.into_iter().map(RigProblem::Toml).collect()))?;
    assemble(&plan).map_err(|problems| {
        let placed = |located: Located| placed_in(&file, &plan, &spans, located);
        RigError::new(problems.into_iter().map(placed).collect())
    })
}

/// Reads the files of a plan made elsewhere.
///
/// # Errors
/// [`RigError`] with all that is wrong.
pub fn load_plan(plan: &Plan) -> Result<Loaded, RigError> {
    assemble(plan)
        .map_err(|problems| RigError::new(problems.into_iter().map(|located| located.problem).collect()))
}

/// What belongs to a record of the rig file is told there.
fn placed_in(file: &TomlFile, plan: &Plan, spans: &[Range<usize>], located: Located) -> RigProblem {
    let Some(record) = located.record else { return located.problem };
    let span = spans[record].clone();
    match located.problem {
        RigProblem::File(FileError::Missing { path }) => RigProblem::Toml(file.error(
            span,
            format!("the record's file {path} does not exist"),
            "correct `file`; it is taken relative to the folder of the rig file",
        )),
        RigProblem::File(FileError::Directory { path, .. }) => RigProblem::Toml(file.error(
            span,
            format!("{path} is a folder, not a CSV file"),
            "give the CSV file of the record; `file` is taken relative to the folder of the rig file",
        )),
        RigProblem::Data(error) if matches!(error.problem, DataProblem::NeverMoves { .. }) => {
            let DataProblem::NeverMoves { column } = &error.problem else { return RigProblem::Data(error) };
            RigProblem::Toml(file.error(
                span,
                format!(
                    "the input `{column}` never moves in `{}` nor in any other fit record",
                    plan.records[record].named
                ),
                error.problem.remedy(),
            ))
        }
        other => other,
    }
}

/// The plan, and where each record's file is named.
fn plan(file: &TomlFile) -> Result<(Plan, Vec<Range<usize>>), Vec<TomlError>> {
    refuse_other_kinds(file).map_err(|error| vec![error])?;
    let (wire, mut problems) = file.parse_all::<WireRig>();
    let Some(wire) = wire else { return Err(problems) };
    let is_whole = problems.is_empty();
    let mut noted = |problem: Result<(), TomlError>| problems.extend(problem.err());
    let order = wire.order.as_ref().map_or(Ok(None), |order| check_order(file, order).map(Some));
    let interval = wire.interval.as_ref().map_or(Ok(None), |ends| check_interval(file, ends).map(Some));
    noted(check_name(file, &wire, is_whole));
    noted(wire.sample_time.as_ref().map_or(Ok(()), |time| check_sample_time(file, time)));
    let order = order.map_err(|error| noted(Err(error))).unwrap_or_default();
    let interval = interval.map_err(|error| noted(Err(error))).unwrap_or_default();
    if let (Some(name), true) = (&wire.name, wire.record.is_empty() && is_whole) {
        noted(Err(file.error(
            name.span(),
            "the rig has no record",
            "add a table [[record]] with `file`, `role` and `use` for every CSV file",
        )));
    }
    let found: Vec<_> = wire.record.iter().map(|record| planned(file, record, is_whole)).collect();
    let (mut records, mut spans) = (Vec::new(), Vec::new());
    for record in found {
        match record {
            Ok((record, span)) => {
                records.push(record);
                spans.push(span);
            }
            Err(found) => found.into_iter().for_each(|error| noted(Err(error))),
        }
    }
    noted(check_uses(file, &records, &spans));
    check_twins(file, &records, &spans).into_iter().for_each(|error| noted(Err(error)));
    if !problems.is_empty() {
        return Err(problems);
    }
    let plan = Plan {
        name: wire.name.map(Spanned::into_inner).unwrap_or_default(),
        columns: names(&wire.columns),
        sampling: Sampling {
            sample_time: wire.sample_time.map(Spanned::into_inner),
            resample: wire.resample,
        },
        order,
        interval,
        input_label: wire.input,
        output_label: wire.output,
        records,
        voice: Voice::Manifest,
    };
    Ok((plan, spans))
}

/// A file of the wrong kind is told as such, rather than by its first unknown key.
fn refuse_other_kinds(file: &TomlFile) -> Result<(), TomlError> {
    let table: Option<toml::Table> = file.text().parse().ok();
    if table.is_some_and(|table| table.contains_key("study") && !table.contains_key("record")) {
        return Err(file.error(
            0..0,
            "this is a scenario, but a rig file is wanted",
            format!("run a scenario with `switchback {}`", file.path().display()),
        ));
    }
    Ok(())
}

fn names(WireColumns { time, input, output }: &WireColumns) -> ColumnNames {
    ColumnNames { time: time.clone(), input: input.clone(), output: output.clone() }
}

fn missing(file: &TomlFile, span: Range<usize>, key: &str) -> TomlError {
    file.error(span, format!("missing key `{key}`"), format!("add `{key} = …`"))
}

/// Where keys were refused already, one that is missing may be among them.
fn check_name(file: &TomlFile, wire: &WireRig, is_whole: bool) -> Result<(), TomlError> {
    match &wire.name {
        Some(name) if name.get_ref().trim().is_empty() => {
            Err(file.error(name.span(), "`name` is empty", "give the rig a name"))
        }
        None if is_whole => Err(missing(file, 0..0, "name")),
        _ => Ok(()),
    }
}

fn check_sample_time(file: &TomlFile, time: &Spanned<f64>) -> Result<(), TomlError> {
    let sample_time = *time.get_ref();
    if sample_time.is_finite() && sample_time > 0.0 {
        return Ok(());
    }
    Err(file.error(
        time.span(),
        format!("`sample_time = {sample_time}` is no time between samples"),
        "give a positive number of seconds, or leave it out where a time column tells it",
    ))
}

fn check_order(file: &TomlFile, order: &Spanned<i64>) -> Result<usize, TomlError> {
    let found = *order.get_ref();
    usize::try_from(found).ok().filter(|_| (1..=MAX_ORDER).contains(&found)).ok_or_else(|| {
        file.error(
            order.span(),
            format!("`order = {found}` is no order of the linear part"),
            format!("give a whole number from 1 to {MAX_ORDER}, or leave `order` out to have it chosen from the data"),
        )
    })
}

fn check_interval(file: &TomlFile, ends: &Spanned<Vec<f64>>) -> Result<Interval, TomlError> {
    let found = match ends.get_ref()[..] {
        [low, high] => Interval::new(low, high).map_err(|error| error.to_string()),
        ref other => Err(format!("{} numbers are no interval; it has two ends", other.len())),
    };
    found.map_err(|reason| {
        file.error(
            ends.span(),
            format!("`interval`: {reason}"),
            "write `[h_m, h_M]`, the lower end first, or leave `interval` out to use the range of the records",
        )
    })
}

fn planned(
    file: &TomlFile,
    record: &Spanned<WireRecord>,
    is_whole: bool,
) -> Result<(PlannedRecord, Range<usize>), Vec<TomlError>> {
    let wire = record.get_ref();
    let mut problems = Vec::new();
    if let (None, true) = (&wire.file, is_whole) {
        problems.push(missing(file, record.span(), "file"));
    }
    if let (None, true) = (wire.usage, is_whole) {
        problems.push(missing(file, record.span(), "use"));
    }
    let usage = wire.usage.map_or(Usage::Fit, Usage::from);
    if let Some(share) = &wire.holdout {
        let told = |message: String, remedy: &str| file.error(share.span(), message, remedy);
        if !(*share.get_ref() > 0.0 && *share.get_ref() < 1.0) {
            let message = format!("`holdout = {}` is no share of a record", share.get_ref());
            problems.push(told(
                message,
                "give a number between 0 and 1: that share of the record, at its end, is held out",
            ));
        } else if usage == Usage::Holdout {
            let message =
                "`holdout` says which share of a fit record is held out, but all of this one is".to_owned();
            problems.push(told(message, "leave `holdout` out, or write `use = \"fit\"`"));
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let (named, span) = match &wire.file {
        Some(named) => (named.get_ref().clone(), named.span()),
        None => (String::new(), record.span()),
    };
    let record = PlannedRecord {
        path: file.path().parent().unwrap_or(Path::new("")).join(&named),
        named,
        columns: names(&wire.columns),
        role: wire.role.into(),
        usage,
        held_out: wire.holdout.as_ref().map(|share| *share.get_ref()),
    };
    Ok((record, span))
}

fn check_uses(file: &TomlFile, records: &[PlannedRecord], spans: &[Range<usize>]) -> Result<(), TomlError> {
    match spans.first() {
        Some(first) if records.iter().all(|record| record.usage != Usage::Fit) => Err(file.error(
            first.clone(),
            "no record has `use = \"fit\"`, so there is nothing to identify from",
            "write `use = \"fit\"` for at least one record",
        )),
        _ => Ok(()),
    }
}

fn check_twins(file: &TomlFile, records: &[PlannedRecord], spans: &[Range<usize>]) -> Vec<TomlError> {
    let mut seen = HashSet::new();
    let mut problems = Vec::new();
    for (record, span) in records.iter().zip(spans) {
        let parts = Path::new(&record.named).components().filter(|part| *part != Component::CurDir);
        if !seen.insert(parts.collect::<Vec<_>>()) {
            problems.push(file.error(
                span.clone(),
                format!("`{}` is listed twice", record.named),
                "list each file once; a hold-out that is also fitted proves nothing",
            ));
        }
    }
    problems
}
