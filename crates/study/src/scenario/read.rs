//! From text to a scenario: parse, take the borders apart by kind, convert.

use super::border::{self, WireBorder};
use super::error::Fault;
use super::take::take;
use super::wire::WireScenario;
use super::{Scenario, ScenarioError, convert};
use serde::Deserialize;
use std::path::Path;
use switchback_io::input::{TomlFile, stream};
use toml::de::{DeTable, DeValue, Deserializer};

impl Scenario {
    /// Reads and checks a scenario file; its stem becomes the scenario's name.
    ///
    /// # Errors
    /// [`ScenarioError`] if the file cannot be read or holds anything that is not a valid scenario.
    pub fn read(path: &Path) -> Result<Self, ScenarioError> {
        scenario(&TomlFile::read(path)?)
    }

    /// Checks a scenario given as text. `file` is what messages call it; its stem becomes the scenario's name.
    ///
    /// # Errors
    /// [`ScenarioError::Invalid`] if the text is not a valid scenario.
    pub fn parse(file: &str, text: &str) -> Result<Self, ScenarioError> {
        scenario(&TomlFile::from_text(Path::new(file), text))
    }
}

/// Reads a scenario; its name is the file's stem.
fn scenario(file: &TomlFile) -> Result<Scenario, ScenarioError> {
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
    let remedy = "write study = \"consistency\", or study = \"blind\" or \"field\" for an examination";
    let Some(study) = take(document, "study") else {
        return Err(Fault::new(0..0, "the scenario has no `study`", remedy));
    };
    match study.get_ref().as_str() {
        Some("consistency") => Ok(()),
        Some("blind" | "field") => Err(Fault::new(
            study.span(),
            "this is an examination of the diagnosis, which has no estimators",
            "name a scenario with study = \"consistency\"",
        )),
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
