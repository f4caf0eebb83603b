//! From a rig file to a [`Plan`], and from that to a [`Rig`].

use super::assemble::{Loaded, Located, assemble, probe};
use super::check;
use super::plan::{Plan, PlannedRecord};
use super::problem::{RigError, RigProblem};
use super::wire::{KEYS, WireColumns, WireRecord, WireRig};
use crate::input::{FileError, FileKind, TomlError, TomlFile, closest, stream};
use crate::output::path_in_shell;
use std::ops::Range;
use std::path::Path;
use switchback_model::rig::{Rig, Usage};
use switchback_table::signals::{ColumnNames, InputForm, Sampling};
use switchback_table::table::DataProblem;
use toml::Spanned;

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
    refuse_other_kinds(&file)?;
    let Draft { plan, spans, problems } = draft(&file);
    let found = match problems.is_empty() {
        true => match assemble(&plan) {
            Ok(loaded) => return Ok(loaded),
            Err(found) => found,
        },
        // Faults of the records that do not come from those of the rig file.
        false => probe(&plan),
    };
    let mut placed: Vec<(usize, RigProblem)> =
        problems.into_iter().map(|problem| (problem.line(), problem.into())).collect();
    placed.extend(found.into_iter().map(|located| {
        let record = located.record;
        let problem = placed_in(&file, &plan, &spans, located);
        let line = match (&problem, record) {
            (RigProblem::Toml(problem), _) => problem.line(),
            (_, Some(record)) => file.line(&spans[record]),
            (_, None) => usize::MAX,
        };
        (line, problem)
    }));
    placed.sort_by_key(|(line, _)| *line);
    Err(RigError::new(placed.into_iter().map(|(_, problem)| problem).collect()))
}

/// Reads the files of a plan made elsewhere.
///
/// # Errors
/// [`RigError`] with all that is wrong.
pub fn load_plan(plan: &Plan) -> Result<Loaded, RigError> {
    assemble(plan)
        .map_err(|problems| RigError::new(problems.into_iter().map(|located| located.problem).collect()))
}

/// What belongs to a record of the rig file is reported there.
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

/// A label stands on one line.
fn one_line(label: String) -> String {
    label.replace(['\n', '\r'], " ")
}

/// What a rig file says, as far as it can be read.
struct Draft {
    plan: Plan,
    /// Where each record's file is named.
    spans: Vec<Range<usize>>,
    /// What is wrong in it.
    problems: Vec<TomlError>,
}

fn draft(file: &TomlFile) -> Draft {
    let (wire, mut problems) = file.parse_all::<WireRig>();
    let wire = wire.unwrap_or_default();
    let keys = Keys::of(file);
    let mut noted = |problem: Result<(), TomlError>| problems.extend(problem.err());
    let order = wire.order.as_ref().map_or(Ok(None), |order| check::order(file, order).map(Some));
    let interval = wire.interval.as_ref().map_or(Ok(None), |ends| check::interval(file, ends).map(Some));
    let resample = wire.resample.as_ref().map_or(Ok(None), |how| check::resample(file, how));
    let resample = resample.map_err(|error| noted(Err(error))).unwrap_or_default();
    noted(check::name(file, &wire, keys.lacks("name")));
    noted(wire.sample_time.as_ref().map_or(Ok(()), |time| check::sample_time(file, time)));
    let order = order.map_err(|error| noted(Err(error))).unwrap_or_default();
    let interval = interval.map_err(|error| noted(Err(error))).unwrap_or_default();
    if wire.record.is_empty() && keys.lacks("record") {
        noted(Err(file.error(
            wire.name.as_ref().map_or(0..0, Spanned::span),
            "the rig has no record",
            "add a table [[record]] with `file`, `role` and `use` for every CSV file",
        )));
        if keys.lacks("sample_time") {
            noted(Err(file.error(
                0..0,
                "missing key `sample_time`",
                "add `sample_time = SECONDS`; it may be left out only where a time column shows it",
            )));
        }
    }
    let (mut records, mut spans) = (Vec::new(), Vec::new());
    for (k, wire) in wire.record.iter().enumerate() {
        let (record, span) = planned(file, wire);
        for error in record_faults(file, wire, &keys.of_record(k)) {
            noted(Err(error));
        }
        if wire.get_ref().file.is_some() {
            records.push(record);
            spans.push(span);
        }
    }
    noted(check::uses(file, &records, &spans));
    check::confounded_effects(file, &records, &spans).into_iter().for_each(|error| noted(Err(error)));
    let plan = Plan {
        name: wire.name.map(Spanned::into_inner).unwrap_or_default(),
        columns: names(&wire.columns),
        sampling: Sampling { sample_time: wire.sample_time.map(Spanned::into_inner), resample },
        order,
        interval,
        input_label: wire.input.map(one_line),
        output_label: wire.output.map(one_line),
        records,
        input_form: InputForm::Manifest,
    };
    Draft { plan, spans, problems }
}

/// The keys of a table as they are written, whether their values can be used or not.
struct Keys(Option<toml::Table>);

impl Keys {
    fn of(file: &TomlFile) -> Self {
        Self(file.text().parse().ok())
    }

    fn of_record(&self, k: usize) -> Self {
        let record = self.0.as_ref().and_then(|table| table.get("record")?.get(k)?.as_table());
        Self(record.cloned())
    }

    /// Whether a key is missing rather than misspelt; `role` is no misspelt `file`.
    fn lacks(&self, key: &str) -> bool {
        let Some(table) = &self.0 else { return false };
        let mut unknown = table.keys().filter(|other| !KEYS.contains(&other.as_str()));
        !table.contains_key(key) && unknown.all(|other| closest(other, [key]).is_none())
    }
}

/// A file of the wrong kind is reported as such, rather than by its first unknown key.
fn refuse_other_kinds(file: &TomlFile) -> Result<(), TomlError> {
    let shown = path_in_shell(file.path());
    let (kind, remedy) = match FileKind::of(file.path()) {
        Some(FileKind::Scenario) => ("a scenario", format!("run a scenario with `switchback {shown}`")),
        Some(FileKind::Data) => (
            "data",
            format!("write its rig file first: `switchback init {shown} --out rig.toml`, and give that"),
        ),
        Some(FileKind::Json(kind)) => (kind, "give a rig file, or files of measurements".to_owned()),
        Some(FileKind::Rig) | None => return Ok(()),
    };
    Err(file.error(0..0, format!("this is {kind}, but a rig file is wanted"), remedy))
}

fn names(WireColumns { time, input, output }: &WireColumns) -> ColumnNames {
    ColumnNames { time: time.clone(), input: input.clone(), output: output.clone() }
}

/// A record, and where its file is named.
fn planned(file: &TomlFile, record: &Spanned<WireRecord>) -> (PlannedRecord, Range<usize>) {
    let wire = record.get_ref();
    let (named, span) = match &wire.file {
        Some(named) => (named.get_ref().clone(), named.span()),
        None => (String::new(), record.span()),
    };
    let record = PlannedRecord {
        path: stream::folder(file.path()).join(&named),
        named,
        columns: names(&wire.columns),
        role: wire.role.into(),
        usage: wire.usage.map_or(Usage::Fit, Usage::from),
        held_out: wire.holdout.as_ref().map(|share| *share.get_ref()),
    };
    (record, span)
}

fn record_faults(file: &TomlFile, record: &Spanned<WireRecord>, keys: &Keys) -> Vec<TomlError> {
    let wire = record.get_ref();
    let mut problems = Vec::new();
    for (key, is_there) in
        [("file", wire.file.is_some()), ("use", wire.usage.is_some() || wire.holdout.is_some())]
    {
        if !is_there && keys.lacks(key) {
            problems.push(check::missing(file, record.span(), key));
        }
    }
    if let Some(share) = &wire.holdout {
        let reported = |message: String, remedy: &str| file.error(share.span(), message, remedy);
        if !(*share.get_ref() > 0.0 && *share.get_ref() < 1.0) {
            let message = format!("`holdout = {}` is no share of a record", share.get_ref());
            problems.push(reported(
                message,
                "give a number between 0 and 1: that share of the record, at its end, is held out",
            ));
        } else if wire.usage.map(Usage::from) == Some(Usage::Holdout) {
            let message =
                "`holdout` says which share of a fit record is held out, but all of this one is".to_owned();
            problems.push(reported(message, "leave `holdout` out, or write `use = \"fit\"`"));
        }
    }
    problems
}
