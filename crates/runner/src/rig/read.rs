//! From a rig file to a [`Rig`] that cannot be wrong.

use super::csv_error::CsvError;
use super::csv_read::{self, Demands};
use super::wire::{WireRecord, WireRig};
use crate::input::{FileError, TomlError, TomlFile, read_text};
use miette::Diagnostic;
use std::collections::HashSet;
use std::path::{Component, Path};
use switchback_estimator::Record;
use switchback_estimator::hysteresis::Interval;
use switchback_estimator::rig::{Rig, RigRecord, Usage};
use thiserror::Error;

/// Why a rig could not be read. Each message names file, place and remedy.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum RigError {
    /// The rig file could not be read as text.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// Something in the rig file is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Toml(#[from] TomlError),
    /// Something in a record's CSV file is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Csv(#[from] CsvError),
}

/// Highest order that a rig file may ask for; beyond it the coefficients drown in rounding errors.
const MAX_ORDER: i64 = 20;

/// Reads a rig file and the CSV files it names, which lie relative to its folder.
///
/// # Errors
/// [`RigError`] at the first thing that is wrong, in the rig file first, then in the records in their order.
pub fn read(path: &Path) -> Result<Rig, RigError> {
    let file = TomlFile::read(path)?;
    let wire = parse(&file)?;
    let (order, interval) = check_header(&file, &wire)?;
    check_records(&file, &wire)?;

    let sample_time = *wire.sample_time.get_ref();
    let demands = Demands { sample_time, samples: samples_needed(order) };
    let names = record_names(&wire.record);
    let mut records = Vec::with_capacity(wire.record.len());
    for (record, name) in wire.record.iter().zip(names) {
        records.push(read_record(&file, record, name, demands)?);
    }
    check_motion(&file, &wire, &records)?;

    Ok(Rig {
        name: wire.name.into_inner(),
        sample_time,
        order,
        interval,
        input_label: wire.input.unwrap_or_else(|| "input v".to_owned()),
        output_label: wire.output.unwrap_or_else(|| "output y".to_owned()),
        records,
    })
}

/// A file of the wrong kind is told as such, rather than by its first unknown key.
fn parse(file: &TomlFile) -> Result<WireRig, TomlError> {
    let table: Option<toml::Table> = file.text().parse().ok();
    if file.path().extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        return Err(file.error(
            0..0,
            "this is a CSV file, but a rig file is wanted",
            "write a rig.toml that names this record, and give that",
        ));
    }
    if table.is_some_and(|table| table.contains_key("study") && !table.contains_key("sample_time")) {
        return Err(file.error(
            0..0,
            "this is a scenario, but a rig file is wanted",
            format!("run a scenario with `switchback {}`", file.path().display()),
        ));
    }
    file.parse()
}

fn check_header(file: &TomlFile, wire: &WireRig) -> Result<(Option<usize>, Option<Interval>), TomlError> {
    if wire.name.get_ref().trim().is_empty() {
        return Err(file.error(wire.name.span(), "`name` is empty", "give the rig a name"));
    }
    let sample_time = *wire.sample_time.get_ref();
    if !(sample_time.is_finite() && sample_time > 0.0) {
        return Err(file.error(
            wire.sample_time.span(),
            format!("`sample_time = {sample_time}` is no time between samples"),
            "give a positive number of seconds",
        ));
    }
    if let Some(order) = &wire.order
        && !(1..=MAX_ORDER).contains(order.get_ref())
    {
        return Err(file.error(
            order.span(),
            format!("`order = {}` is no order of the linear part", order.get_ref()),
            format!("give a whole number from 1 to {MAX_ORDER}, or leave `order` out to have it chosen from the data"),
        ));
    }
    let interval = wire.interval.as_ref().map(|ends| {
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
    });
    let order = wire.order.as_ref().and_then(|order| usize::try_from(*order.get_ref()).ok());
    Ok((order, interval.transpose()?))
}

fn check_records(file: &TomlFile, wire: &WireRig) -> Result<(), TomlError> {
    let usage = |record: &WireRecord| Usage::from(record.usage);
    if wire.record.is_empty() {
        return Err(file.error(
            wire.name.span(),
            "the rig has no record",
            "add a table [[record]] with `file`, `role` and `use` for every CSV file",
        ));
    }
    if !wire.record.iter().any(|record| usage(record) == Usage::Fit) {
        return Err(file.error(
            wire.record[0].file.span(),
            "no record has `use = \"fit\"`, so there is nothing to identify from",
            "write `use = \"fit\"` for at least one record",
        ));
    }
    let mut seen = HashSet::new();
    for record in &wire.record {
        let parts = Path::new(record.file.get_ref()).components().filter(|part| *part != Component::CurDir);
        if !seen.insert(parts.collect::<Vec<_>>()) {
            return Err(file.error(
                record.file.span(),
                format!("`{}` is listed twice", record.file.get_ref()),
                "list each file once; a hold-out that is also fitted proves nothing",
            ));
        }
    }
    Ok(())
}

/// Equations of order n reach back n samples and have 2n coefficients and at least two border values; one sample more
/// leaves a residual. Ten at the least, since no order at all can be chosen from fewer.
fn samples_needed(order: Option<usize>) -> usize {
    order.map_or(10, |n| (3 * n + 3).max(10))
}

/// The file's name without its ending; where two records would share it, with the folders before it, and where even
/// these are alike, with a number after it. Names become parts of file names, so they hold no separators.
fn record_names(records: &[WireRecord]) -> Vec<String> {
    let parts = |record: &WireRecord| -> Vec<String> {
        let path = Path::new(record.file.get_ref()).with_extension("");
        let named = path.components().filter(|part| matches!(part, Component::Normal(_)));
        named.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
    };
    let stems: Vec<String> =
        records.iter().map(|record| parts(record).pop().unwrap_or_else(|| "record".to_owned())).collect();
    let mut names: Vec<String> = Vec::with_capacity(records.len());
    for (record, stem) in records.iter().zip(&stems) {
        let is_shared = stems.iter().filter(|other| *other == stem).count() > 1;
        let name = if is_shared { parts(record).join("-") } else { stem.clone() };
        let mut free = name.clone();
        let mut count = 1;
        while names.contains(&free) {
            count += 1;
            free = format!("{name}-{count}");
        }
        names.push(free);
    }
    names
}

fn read_record(
    file: &TomlFile,
    wire: &WireRecord,
    name: String,
    demands: Demands,
) -> Result<RigRecord, RigError> {
    let path = file.path().parent().unwrap_or(Path::new("")).join(wire.file.get_ref());
    let text = read_text(&path).map_err(|error| match error {
        FileError::Missing { path } => RigError::Toml(file.error(
            wire.file.span(),
            format!("the record's file {path} does not exist"),
            "correct `file`; it is taken relative to the folder of the rig file",
        )),
        FileError::Directory { path, .. } => RigError::Toml(file.error(
            wire.file.span(),
            format!("{path} is a folder, not a CSV file"),
            "give the CSV file of the record; `file` is taken relative to the folder of the rig file",
        )),
        other => RigError::File(other),
    })?;
    let columns = csv_read::parse(&path, &text, demands)?;
    let record = Record::new(columns.v, columns.y)
        .map_err(|error| file.error(wire.file.span(), error.to_string(), "correct the record's file"))?;
    Ok(RigRecord { name, role: wire.role.into(), usage: wire.usage.into(), record, predicted: columns.y_sim })
}

/// A system that was never moved cannot be identified.
fn check_motion(file: &TomlFile, wire: &WireRig, records: &[RigRecord]) -> Result<(), TomlError> {
    let stands = |record: &RigRecord| record.record.v().windows(2).all(|pair| pair[0] == pair[1]);
    if !records.iter().filter(|record| record.usage == Usage::Fit).all(stands) {
        return Ok(());
    }
    let first = wire.record.iter().position(|record| Usage::from(record.usage) == Usage::Fit).unwrap_or(0);
    Err(file.error(
        wire.record[first].file.span(),
        format!(
            "the input `v` never moves in `{}` nor in any other fit record",
            wire.record[first].file.get_ref()
        ),
        "fit to records in which `v` rises and falls; check that the column `v` holds the input",
    ))
}
