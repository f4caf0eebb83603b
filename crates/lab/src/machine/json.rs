//! What was put in as JSON.

use crate::generate::InjectedFault;
use switchback_io::output::stamped;

/// Name and version of the layout.
const SCHEMA: &str = "switchback/plant/1";

/// Effect, law, magnitude and size as one JSON object.
pub fn json(fault: &InjectedFault) -> String {
    let page = serde_json::json!({
        "effect": fault.effect, "law": fault.law, "stage": fault.stage.name(), "planting": fault.injection.name(),
        "exact": fault.injection.is_exact(), "magnitude": fault.magnitude, "unit": fault.unit,
        "wanted_size": fault.wanted, "size": fault.size, "raw_size": fault.raw, "residual": fault.residual,
        "observable": fault.is_observable(),
    });
    stamped(SCHEMA, &page)
}
