//! Which of the files of this program one is, to show those who gave another.

use serde_json::Value;
use std::path::Path;
use switchback_table::read_decoded;
use switchback_table::table::Table;

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// A file of measurements.
    Data,
    /// A rig file.
    Rig,
    /// A scenario.
    Scenario,
    /// What a verb wrote: `a diagnosis`.
    Json(&'static str),
}

impl FileKind {
    /// By its content; none where it cannot be read or is nothing of the kind.
    pub fn of(path: &Path) -> Option<Self> {
        let is_ending =
            |wanted: &str| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(wanted));
        if ["mat", "mcap", "mf4", "parquet"].into_iter().any(is_ending) {
            return path.is_file().then_some(Self::Data);
        }
        let text = read_decoded(path).ok()?;
        if let Ok(value) = serde_json::from_str::<Value>(&text) {
            return of_json(&value).map(Self::Json);
        }
        if let Ok(page) = text.parse::<toml::Table>() {
            return if page.contains_key("study") {
                Some(Self::Scenario)
            } else {
                page.contains_key("record").then_some(Self::Rig)
            };
        }
        let is_table = || Table::parse(&text, 2).is_ok_and(|table| table.places.len() > 1);
        (!is_ending("toml") && is_table()).then_some(Self::Data)
    }
}

/// What an object of this program is; none where it is no such object.
pub(super) fn of_json(value: &Value) -> Option<&'static str> {
    let written = [
        ("switchback/gap/", "a diagnosis"),
        ("switchback/model/", "a model"),
        ("switchback/identify/", "an identification"),
        ("switchback/simulate/", "the report of a simulation"),
        ("switchback/blind/", "the results of a blind study"),
        ("switchback/field/", "the results of a field examination"),
        ("switchback/rig-list/", "a list of effects"),
        ("switchback/design/", "a plan of experiments"),
        ("switchback/compare/", "a comparison"),
        ("switchback/bench/", "a comparison of two versions"),
        ("switchback/power/", "the power of some records"),
        ("switchback/verdict/", "a fitted verdict"),
        ("switchback/plant/", "what was planted into records"),
        ("switchback/selftest/", "the outcome of a self-test"),
        ("switchback/provenance/", "the provenance of some results"),
        ("switchback/part/", "the label of a part of a study"),
        ("switchback/rig/", "what was put into a made rig"),
    ];
    match value.get("schema")? {
        Value::String(schema) => {
            written.into_iter().find(|(start, _)| schema.starts_with(start)).map(|(_, reported)| reported)
        }
        Value::Number(_) => value.get("cells").map(|_| "the results of a study"),
        _ => None,
    }
}
