//! A model file in memory, and as text.

use super::Domain;
use super::described::Described;
use super::system::System;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fmt::Write;

/// The format that is written, and the only one that is read.
pub(crate) const SCHEMA: &str = "switchback/model/1";

/// A model with all that is known about it.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelFile {
    /// Where it comes from.
    pub header: Header,
    /// What runs.
    pub system: System,
}

/// What a model file says besides the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// `identified`, `nominal` or `augmented`.
    pub part: String,
    /// The rig's name.
    pub rig: String,
    /// Method of `identify`.
    pub method: Option<String>,
    /// Label and unit of the input.
    pub input: String,
    /// Label and unit of the output.
    pub output: String,
    /// Seconds between samples.
    pub sample_time: f64,
    /// What the model was identified on.
    pub identified_on: Domain,
    /// What was added to the nominal model.
    pub effects: Vec<Added>,
}

/// An effect in a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Added {
    /// Its name.
    pub effect: String,
    /// Its parameters in the user's units.
    pub parameters: Vec<Parameter>,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// The estimate.
    pub value: Option<f64>,
    /// Its 90 % interval, where the likelihood gives one.
    pub ci90: [Option<f64>; 2],
    /// Its unit; empty for a pure number.
    pub unit: String,
}

impl ModelFile {
    /// The file: one key a line, those of `model` too.
    pub fn text(&self) -> String {
        let mut text = format!("{{\n  \"schema\": \"{SCHEMA}\",\n  \"kind\": \"{}\",\n", self.system.kind());
        let header = serde_json::to_value(&self.header).expect("strings and numbers are JSON");
        for key in ["part", "rig", "method", "input", "output", "sample_time", "identified_on", "effects"] {
            let _ = writeln!(text, "  \"{key}\": {},", header[key]);
        }
        let _ = writeln!(text, "  \"version\": \"{}\",", env!("CARGO_PKG_VERSION"));
        let system = serde_json::to_value(Described::of(&self.system)).expect("numbers are JSON");
        let _ = writeln!(text, "  \"system\": {},", by_line(&system));
        let _ = writeln!(text, "  \"model\": {}\n}}", by_line(&self.system.value()));
        text
    }
}

/// An object with one key a line, inside another.
fn by_line(value: &Value) -> String {
    let Value::Object(fields) = value else { return value.to_string() };
    let lines: Vec<String> = fields.iter().map(|(key, value)| format!("    \"{key}\": {value}")).collect();
    format!("{{\n{}\n  }}", lines.join(",\n"))
}
