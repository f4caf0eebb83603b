//! Whether what a rig file says can be.

use super::plan::PlannedRecord;
use super::wire::{WireResample, WireRig};
use crate::input::{TomlError, TomlFile};
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Component, Path};
use switchback_model::hysteresis::Interval;
use switchback_model::rig::Usage;
use switchback_table::signals::Between;
use toml::Spanned;

/// Highest order that a rig file may ask for; beyond it the coefficients drown in rounding errors.
const MAX_ORDER: i64 = 20;

pub(super) fn missing(file: &TomlFile, span: Range<usize>, key: &str) -> TomlError {
    file.error(span, format!("missing key `{key}`"), format!("add `{key} = …`"))
}

pub(super) fn name(file: &TomlFile, wire: &WireRig, is_missing: bool) -> Result<(), TomlError> {
    match &wire.name {
        Some(name) if name.get_ref().trim().is_empty() => {
            Err(file.error(name.span(), "`name` is empty", "give the rig a name"))
        }
        Some(name) if name.get_ref().contains(char::is_control) => Err(file.error(
            name.span(),
            "`name` holds a control character",
            "write it in letters, on one line",
        )),
        None if is_missing => Err(missing(file, 0..0, "name")),
        _ => Ok(()),
    }
}

pub(super) fn sample_time(file: &TomlFile, time: &Spanned<f64>) -> Result<(), TomlError> {
    let sample_time = *time.get_ref();
    if sample_time.is_finite() && sample_time > 0.0 {
        return Ok(());
    }
    Err(file.error(
        time.span(),
        format!("`sample_time = {sample_time}` is no time between samples"),
        "give a positive number of seconds, or leave it out where a time column shows it",
    ))
}

pub(super) fn order(file: &TomlFile, order: &Spanned<i64>) -> Result<usize, TomlError> {
    let found = *order.get_ref();
    usize::try_from(found).ok().filter(|_| (1..=MAX_ORDER).contains(&found)).ok_or_else(|| {
        file.error(
            order.span(),
            format!("`order = {found}` is no order of the linear part"),
            format!("give a whole number from 1 to {MAX_ORDER}, or leave `order` out to have it chosen from the data"),
        )
    })
}

pub(super) fn resample(file: &TomlFile, how: &Spanned<WireResample>) -> Result<Option<Between>, TomlError> {
    match how.get_ref() {
        WireResample::Switch(is_on) => Ok(is_on.then_some(Between::Linear)),
        WireResample::Named(name) => Between::named(name).map(Some).ok_or_else(|| {
            file.error(
                how.span(),
                format!("`resample = {name:?}` is not known here"),
                "write `\"linear\"`, `\"hold\"`, `true` for linear, or leave it out",
            )
        }),
    }
}

pub(super) fn interval(file: &TomlFile, ends: &Spanned<Vec<f64>>) -> Result<Interval, TomlError> {
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

pub(super) fn uses(
    file: &TomlFile,
    records: &[PlannedRecord],
    spans: &[Range<usize>],
) -> Result<(), TomlError> {
    match spans.first() {
        Some(first) if records.iter().all(|record| record.usage != Usage::Fit) => Err(file.error(
            first.clone(),
            "no record has `use = \"fit\"`, so there is nothing to identify from",
            "write `use = \"fit\"` for at least one record",
        )),
        _ => Ok(()),
    }
}

pub(super) fn confounded_effects(
    file: &TomlFile,
    records: &[PlannedRecord],
    spans: &[Range<usize>],
) -> Vec<TomlError> {
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
