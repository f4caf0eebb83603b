//! A model file in memory, and as text.

use super::Domain;
use super::described::Described;
use super::system::System;
use crate::output::stamped_schema;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fmt::Write;
use switchback_diagnose::Effect;
use switchback_identify::Method;

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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Header {
    /// Where it comes from.
    #[schemars(extend("enum" = Self::PARTS))]
    pub part: String,
    /// The rig's name.
    pub rig: String,
    /// Method of `identify`.
    #[schemars(with = "Option<Method>")]
    pub method: Option<String>,
    /// Label and unit of the input.
    pub input: String,
    /// Label and unit of the output.
    pub output: String,
    /// Seconds between samples.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub sample_time: f64,
    /// The inputs that the model was identified on, input units: `simulate` warns where a new one leaves them.
    pub identified_on: Domain,
    /// What was added to the nominal model.
    pub effects: Vec<Added>,
}

/// An effect in a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Added {
    /// The effect.
    #[schemars(with = "Effect")]
    pub effect: String,
    /// Its parameters in the user's units.
    pub parameters: Vec<Parameter>,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// The estimate; null where it is no finite number.
    pub value: Option<f64>,
    /// Ends of its 90 % interval; null where the likelihood gives none.
    pub ci90: [Option<f64>; 2],
    /// Its unit; empty for a pure number.
    pub unit: String,
}

impl Header {
    /// What `part` may be.
    pub const PARTS: [&str; 4] = ["identified", "nominal", "augmented", "aligned"];
}

/// A model that runs anywhere: `model.json`, `nominal.json`, `augmented.json`.
#[derive(Serialize, JsonSchema)]
struct Written<'a> {
    /// Form of `model`.
    #[schemars(extend("enum" = ["switched", "curves", "machine", "points"]))]
    kind: &'a str,
    #[serde(flatten)]
    header: &'a Header,
    /// Version of Switchback that wrote it.
    version: &'a str,
    /// The system without effects in physical units, for the reader: `A(q⁻¹) y(t) = Σ bᵢ u(t−delay−i)`, i from 1.
    system: Described,
    /// All that a free run depends on, to the last bit; its form follows `kind`.
    model: &'a System,
}

/// The keys of a file behind `schema`, in their order.
const KEYS: [&str; 12] = [
    "kind",
    "part",
    "rig",
    "method",
    "input",
    "output",
    "sample_time",
    "identified_on",
    "effects",
    "version",
    "system",
    "model",
];

/// The JSON Schema of a model file.
pub fn schema() -> Schema {
    stamped_schema::<Written<'_>>(SCHEMA)
}

impl ModelFile {
    /// The file: one key a line, those of `system` and `model` too.
    pub fn text(&self) -> String {
        let written = Written {
            kind: self.system.kind(),
            header: &self.header,
            version: env!("CARGO_PKG_VERSION"),
            system: Described::of(&self.system),
            model: &self.system,
        };
        let written =
            serde_json::to_value(written).expect("finite numbers, strings and lists of them are JSON");
        let mut text = format!("{{\n  \"schema\": \"{SCHEMA}\"");
        for key in KEYS {
            let value = &written[key];
            let shown = if matches!(key, "system" | "model") { by_line(value) } else { value.to_string() };
            let _ = write!(text, ",\n  \"{key}\": {shown}");
        }
        text + "\n}\n"
    }
}

/// An object with one key a line, inside another.
fn by_line(value: &Value) -> String {
    let Value::Object(fields) = value else { return value.to_string() };
    let lines: Vec<String> = fields.iter().map(|(key, value)| format!("    \"{key}\": {value}")).collect();
    format!("{{\n{}\n  }}", lines.join(",\n"))
}
