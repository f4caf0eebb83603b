//! What was put in as JSON.

use crate::generate::InjectedFault;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use switchback_diagnose::Stage;
use switchback_io::output::{stamped, stamped_schema};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/plant/1";

/// A fault planted into measured records: `plant --json`.
///
/// Keys stand in the order of the alphabet.
#[derive(Serialize, JsonSchema)]
struct Page {
    /// The effect's name.
    effect: &'static str,
    /// Whether the records themselves were changed; else a model carried it.
    exact: bool,
    /// Its law.
    law: &'static str,
    /// Its magnitude.
    magnitude: f64,
    /// Whether the records can show it at all.
    observable: bool,
    /// How it came in.
    #[serde(rename = "planting")]
    injection: &'static str,
    /// What a model given beforehand misses.
    #[schemars(range(min = 0))]
    raw_size: f64,
    /// The residual without the fault, output units.
    #[schemars(range(min = 0))]
    residual: f64,
    /// What survives identification anew, over the residual.
    #[schemars(range(min = 0))]
    size: f64,
    /// Where it acts.
    #[schemars(with = "Stage")]
    stage: &'static str,
    /// Its unit.
    unit: &'static str,
    /// Size asked for.
    #[schemars(range(min = 0))]
    wanted_size: f64,
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<Page>(SCHEMA)
}

/// Effect, law, magnitude and size as one JSON object.
pub fn json(fault: &InjectedFault) -> String {
    let page = Page {
        effect: fault.effect,
        exact: fault.injection.is_exact(),
        law: fault.law,
        magnitude: fault.magnitude,
        observable: fault.is_observable(),
        injection: fault.injection.name(),
        raw_size: fault.raw,
        residual: fault.residual,
        size: fault.size,
        stage: fault.stage.name(),
        unit: fault.unit,
        wanted_size: fault.wanted,
    };
    stamped(SCHEMA, &page)
}
