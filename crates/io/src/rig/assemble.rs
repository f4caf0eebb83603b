//! From a plan to a [`Rig`] that cannot be wrong.

use super::cut::{self, Part};
use super::divided::Divided;
use super::plan::{Plan, PlannedRecord};
use super::problem::RigProblem;
use super::quantity::of_predictions;
use super::reported::{self, Reported};
use crate::input::stream;
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Component, Path};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage, samples_needed};
use switchback_table::signals::{ColumnNames, InputForm, Measured, NO_TIME, Request, Sampling};
use switchback_table::table::{Column, DataError, DataProblem, Table};

/// A rig, with the inferred settings.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The rig.
    pub rig: Rig,
    /// What was inferred, to be reported.
    pub reported: Reported,
    /// The plan with all that was inferred written into it: it gives the same rig again.
    pub plan: Plan,
}

/// A problem, and the record of the plan whose fault it is, where it is one's.
#[derive(Debug)]
pub(super) struct Located {
    pub(super) record: Option<usize>,
    pub(super) problem: RigProblem,
}

/// Reads all files of a plan.
///
/// # Errors
/// All that is wrong with them.
pub(super) fn assemble(plan: &Plan) -> Result<Loaded, Vec<Located>> {
    assemble_measured(plan, read_all(plan)?)
}

/// The same where the records are tables in memory, one each.
///
/// # Errors
/// All that is wrong with them.
pub(super) fn assemble_tables(plan: &Plan, tables: Vec<Table>) -> Result<Loaded, Vec<Located>> {
    let measured = each(plan.records.iter().zip(tables), |(record, table)| {
        Measured::of(table, request(plan, &record.columns.or(&plan.columns)))
    });
    assemble_measured(plan, measured?)
}

fn assemble_measured(plan: &Plan, measured: Vec<Measured>) -> Result<Loaded, Vec<Located>> {
    check_agreement(plan, &measured)?;
    let needed = samples_needed(plan.order);
    let divided = each(plan.records.iter().zip(measured), |(record, measured)| {
        let parts = divide(record, &measured, (needed, &plan.input_form)).map_err(|error| vec![error])?;
        Ok(Divided { measured, parts })
    })?;
    let names = record_names(plan);
    let records = each(divided.iter().zip(&plan.records).zip(names), |((divided, record), name)| {
        rig_records(divided, record, &name).map_err(|error| vec![error])
    })?;
    let first = &divided[0].measured;
    let rig = Rig {
        name: plan.name.clone(),
        sample_time: first.sample_time,
        order: plan.order,
        interval: plan.interval,
        input_label: plan.input_label.clone().unwrap_or_else(|| label(first.input(), "v", "input v")),
        output_label: plan
            .output_label
            .clone()
            .unwrap_or_else(|| first.output().map_or_else(String::new, |y| label(y, "y", "output y"))),
        records: records.into_iter().flatten().collect(),
    };
    check_motion(plan, &rig, first)?;
    Ok(Loaded { reported: reported::describe(plan, &divided), plan: resolved(plan, &rig, &divided), rig })
}

/// Does the same with each, and gives all results or all problems.
fn each<I, R, P: Into<RigProblem>>(
    items: impl Iterator<Item = I>,
    mut work: impl FnMut(I) -> Result<R, Vec<P>>,
) -> Result<Vec<R>, Vec<Located>> {
    let (mut results, mut problems) = (Vec::new(), Vec::new());
    for (record, item) in items.enumerate() {
        match work(item) {
            Ok(result) => results.push(result),
            Err(found) => problems.extend(
                found.into_iter().map(|problem| Located { record: Some(record), problem: problem.into() }),
            ),
        }
    }
    if problems.is_empty() { Ok(results) } else { Err(problems) }
}

fn read_all(plan: &Plan) -> Result<Vec<Measured>, Vec<Located>> {
    each(plan.records.iter(), |record| {
        Measured::read(&record.path, request(plan, &record.columns.or(&plan.columns)))
    })
}

fn request<'a>(plan: &'a Plan, names: &'a ColumnNames) -> Request<'a> {
    Request { names, sampling: plan.sampling, input_form: &plan.input_form, needs_output: true }
}

/// What is wrong with the records of a plan that is wrong itself, as far as that does not follow from its own faults.
pub(super) fn probe(plan: &Plan) -> Vec<Located> {
    let mut found = read_all(plan).err().unwrap_or_default();
    found.retain(|located| match &located.problem {
        RigProblem::File(_) => true,
        RigProblem::Data(error) => matches!(
            error.problem,
            DataProblem::Empty
                | DataProblem::NoTable { .. }
                | DataProblem::HeaderWidth { .. }
                | DataProblem::CommasTwice { .. }
                | DataProblem::Ragged { .. }
                | DataProblem::UnknownColumn { .. }
                | DataProblem::DuplicateColumn { .. }
                | DataProblem::SameColumn { .. }
                | DataProblem::LookAlike { .. }
                | DataProblem::NotANumber { .. }
                | DataProblem::OtherDecimal { .. }
                | DataProblem::OtherUnit { .. }
                | DataProblem::NotFinite { .. }
                | DataProblem::More { .. }
        ),
        RigProblem::Toml(_) | RigProblem::Asked { .. } => false,
    });
    found
}

/// All files must speak of the same quantities at the same sample time.
fn check_agreement(plan: &Plan, measured: &[Measured]) -> Result<(), Vec<Located>> {
    let first = &measured[0];
    let differs = |other: &Measured| -> Option<DataProblem> {
        if (other.sample_time - first.sample_time).abs() > 0.01 * first.sample_time {
            return Some(DataProblem::SampleTimesDiffer {
                here: other.sample_time,
                there: first.sample_time,
                other: first.table.path.clone(),
                remedy: plan.input_form.sample_times_differ(first.sample_time),
            });
        }
        let pairs = [(Some(other.input()), Some(first.input())), (other.output(), first.output())];
        pairs.into_iter().find_map(|(here, there)| {
            let (here, there) = (here?, there?);
            let are_units = here.unit.is_some() && there.unit.is_some() && here.unit != there.unit;
            are_units.then(|| DataProblem::UnitsDiffer {
                here: here.label(),
                there: there.label(),
                other: first.table.path.clone(),
            })
        })
    };
    let problems: Vec<Located> = measured
        .iter()
        .enumerate()
        .filter_map(|(record, other)| {
            let error = DataError { path: other.table.path.clone(), place: None, problem: differs(other)? };
            Some(Located { record: Some(record), problem: error.into() })
        })
        .collect();
    debug_assert_eq!(measured.len(), plan.records.len());
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

fn divide(
    record: &PlannedRecord,
    measured: &Measured,
    (needed, input_form): (usize, &InputForm),
) -> Result<Vec<Part>, DataError> {
    if record.role != Role::Free
        && let Some(interruption) = measured.first_interruption().or_else(|| measured.table.cut_off.clone())
    {
        return Err(interruption);
    }
    cut::divide(&measured.pieces, (record.usage, record.held_out), (needed, input_form))
        .map_err(|problem| DataError { path: measured.table.path.clone(), place: None, problem })
}

fn rig_records(divided: &Divided, record: &PlannedRecord, name: &str) -> Result<Vec<RigRecord>, DataError> {
    let Divided { measured, parts } = divided;
    let of = |values: &[f64], range: &Range<usize>| values[range.clone()].to_vec();
    let output = measured.y.as_deref().unwrap_or_default();
    let factor = of_predictions(measured).unwrap_or(1.0);
    let predicted =
        |values: &[f64], range: &Range<usize>| values[range.clone()].iter().map(|y| factor * y).collect();
    let records = cut::names(name, parts).into_iter().zip(parts).map(|(name, part)| RigRecord {
        name,
        role: record.role,
        usage: part.usage,
        record: Record::new(of(&measured.v, &part.range), of(output, &part.range))
            .expect("rows are samples only where input and output are finite"),
        predicted: measured.predicted.as_deref().map(|values| predicted(values, &part.range)),
    });
    Ok(records.collect())
}

/// `force [N]`, or the name; a column that is called as its signal is called that.
fn label(column: &Column, signal: &str, otherwise: &str) -> String {
    let is_nameless = column.name.eq_ignore_ascii_case(signal) || column.name.starts_with("column ");
    match (&column.unit, is_nameless) {
        (_, false) => column.label(),
        (Some(unit), true) => format!("{otherwise} [{unit}]"),
        (None, true) => otherwise.to_owned(),
    }
}

/// A system that was never moved, or never answered, cannot be identified.
fn check_motion(plan: &Plan, rig: &Rig, first: &Measured) -> Result<(), Vec<Located>> {
    let stands = |of: fn(&Record) -> &[f64]| {
        rig.fit_records().all(|record| of(&record.record).windows(2).all(|pair| pair[0] == pair[1]))
    };
    let problem = if stands(Record::v) {
        DataProblem::NeverMoves { column: first.input().label() }
    } else if stands(Record::y) {
        DataProblem::NeverChanges { column: first.output().map(Column::label).unwrap_or_default() }
    } else {
        return Ok(());
    };
    let record = plan.records.iter().position(|record| record.usage == Usage::Fit).unwrap_or(0);
    let path = plan.records[record].path.display().to_string();
    Err(vec![Located { record: Some(record), problem: DataError { path, place: None, problem }.into() }])
}

/// The plan as it would have to be given to infer nothing.
fn resolved(plan: &Plan, rig: &Rig, divided: &[Divided]) -> Plan {
    let columns: Vec<ColumnNames> = divided.iter().map(|divided| named(&divided.measured)).collect();
    let own = |columns_here: &ColumnNames| {
        let other = |name: &Option<String>, first: &Option<String>| name.clone().filter(|_| name != first);
        ColumnNames {
            time: other(&columns_here.time, &columns[0].time),
            input: other(&columns_here.input, &columns[0].input),
            output: other(&columns_here.output, &columns[0].output),
        }
    };
    let records = plan.records.iter().zip(&columns);
    Plan {
        records: records
            .map(|(record, columns)| PlannedRecord { columns: own(columns), ..record.clone() })
            .collect(),
        columns: columns[0].clone(),
        sampling: Sampling { sample_time: Some(rig.sample_time), ..plan.sampling },
        input_label: Some(rig.input_label.clone()),
        output_label: Some(rig.output_label.clone()),
        input_form: InputForm::Manifest,
        ..plan.clone()
    }
}

/// The names by which a file's columns are found without guessing.
fn named(measured: &Measured) -> ColumnNames {
    let table = &measured.table;
    let name = |k: usize| {
        let column = &table.columns[k];
        let named = table.columns.iter().filter(|other| other.name.eq_ignore_ascii_case(&column.name));
        if table.has_header && !column.name.is_empty() && named.count() == 1 {
            column.name.clone()
        } else {
            (k + 1).to_string()
        }
    };
    let selection = &measured.selection;
    ColumnNames {
        time: Some(selection.time.map_or_else(|| NO_TIME.to_owned(), name)),
        input: Some(name(selection.input)),
        output: selection.output.map(name),
    }
}

/// The file's name without its ending; where two records would share it, with the folders before it, and where even
/// these are alike, with a number after it. Names become parts of file names, so they hold no separators nor control characters.
///
/// A record in memory has no file: it keeps its name, as far as that can be part of one.
fn record_names(Plan { records, input_form, .. }: &Plan) -> Vec<String> {
    let parts = |record: &PlannedRecord| -> Vec<String> {
        if *input_form == InputForm::Arguments {
            let is_kept = |c: char| !c.is_control() && c != '/' && c != '\\';
            return vec![record.named.chars().map(|c| if is_kept(c) { c } else { '_' }).collect()];
        }
        if stream::is_stream(&record.path) {
            return stream::stem(&record.path).into_iter().collect();
        }
        let path = Path::new(&record.named).with_extension("");
        let named = path.components().filter(|part| matches!(part, Component::Normal(_)));
        named.map(|part| part.as_os_str().to_string_lossy().replace(char::is_control, "_")).collect()
    };
    let stems: Vec<String> =
        records.iter().map(|record| parts(record).pop().unwrap_or_else(|| "record".to_owned())).collect();
    let mut names: Vec<String> = Vec::with_capacity(records.len());
    let mut taken = HashSet::new();
    for (record, stem) in records.iter().zip(&stems) {
        let is_shared = stems.iter().filter(|other| *other == stem).count() > 1;
        let name = if is_shared { parts(record).join("-") } else { stem.clone() };
        let mut free = name.clone();
        let mut count = 1;
        while !taken.insert(free.clone()) {
            count += 1;
            free = format!("{name}-{count}");
        }
        names.push(free);
    }
    names
}
