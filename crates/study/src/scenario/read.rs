//! From text to a scenario: parse, take the borders apart by kind, convert.

use super::border::{self, WireBorder};
use super::error::Fault;
use super::wire::WireScenario;
use super::{Scenario, ScenarioError, convert};
use serde::Deserialize;
use switchback_io::input::{TomlFile, stream};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// Reads a scenario; its name is the file's stem.
pub(super) fn scenario(file: &TomlFile) -> Result<Scenario, ScenarioError> {
    let name = stream::stem(file.path()).unwrap_or_else(|| file.path().display().to_string());
    checked(name, file.text()).map_err(|fault| fault.locate(file))
}

fn checked(name: String, text: &str) -> Result<Scenario, Fault> {
    let mut document = DeTable::parse(text)?;
    take_study(document.get_mut())?;
    let borders = take_borders(document.get_mut())?;
    let wire = WireScenario::deserialize(Deserializer::from(document))?;
    let source = toml::from_str(text)?;
    convert::scenario(name, wire, borders, source)
}

/// Takes `study` out of the document. It decides which keys are right, so it is judged before all of them.
fn take_study(document: &mut DeTable<'_>) -> Result<(), Fault> {
    let remedy = "write study = \"consistency\" or study = \"blind\"";
    let Some(study) = take(document, "study") else {
        return Err(Fault::new(0..0, "the scenario has no `study`", remedy));
    };
    match study.get_ref().as_str() {
        Some("consistency") => Ok(()),
        _ => Err(Fault::new(study.span(), "there is no such study", remedy)),
    }
}

/// Takes `[[border]]` out of the document: which keys a border may have depends on its kind.
fn take_borders(document: &mut DeTable<'_>) -> Result<Vec<WireBorder>, Fault> {
    let Some(value) = take(document, "border") else {
        return Err(Fault::new(
            0..0,
            "the scenario has no [[border]]",
            "add at least one [[border]] with name, kind and the kind's parameters",
        ));
    };
    let span = value.span();
    match value.into_inner() {
        DeValue::Array(array) => array.into_iter().map(border::read).collect(),
        _ => Err(Fault::new(span, "border must be a list of tables", "write each as [[border]]")),
    }
}

/// Removes a key from a table and hands over its value.
pub(super) fn take<'i>(table: &mut DeTable<'i>, name: &str) -> Option<Spanned<DeValue<'i>>> {
    let key = table.keys().find(|k| k.get_ref() == name).cloned()?;
    table.remove(&key)
}
