//! What shows that two cells are the same, whoever ran them.

use super::cell::CellSpec;
use crate::MethodName;
use crate::scenario::{Program, Scenario};
use serde_json::{Value, json};
use switchback_io::output::sha256;

/// Digits of a hash that are kept: two cells of a million studies do not agree by chance.
const DIGITS: usize = 24;

/// One entry a cell: a hash of its system, design and method, and of the versions of this program and of the method, as far as they are known.
pub(super) fn strong_ids(scenario: &Scenario, specs: &[CellSpec], versions: &[String]) -> Vec<String> {
    specs.iter().map(|spec| strong_id(scenario, spec, versions)).collect()
}

fn strong_id(scenario: &Scenario, spec: &CellSpec, versions: &[String]) -> String {
    let series = &spec.series;
    let case = scenario.cases().iter().find(|case| case.name == series.case);
    let system = case.map(|case| {
        let interval = case.interval();
        json!({
            "a": case.system.a(), "b": case.system.b(), "interval": [interval.low(), interval.high()],
            "disturbance": format!("{:?}", case.disturbance), "order": case.order, "spacing": case.spacing,
            "knots": case.knots.name(), "fit": case.fit.name(),
        })
    });
    let borders = scenario.source()["border"].as_array();
    let border = borders.and_then(|all| all.iter().find(|border| border["name"] == series.border.as_str()));
    let design = json!({ "points": series.points, "noise": series.noise, "samples": spec.samples });
    let of = json!({
        "system": system, "border": border, "design": design, "method": method(scenario, &series.method, versions),
        "version": env!("CARGO_PKG_VERSION"),
    });
    let mut hash = sha256(of.to_string());
    hash.truncate(DIGITS);
    hash
}

fn method(scenario: &Scenario, name: &MethodName, versions: &[String]) -> Value {
    let found = scenario.foreign().iter().position(|method| method.name.as_str() == name.name());
    let Some(place) = found.filter(|_| name.is_foreign()) else { return json!(name) };
    let method = &scenario.foreign()[place];
    let command = match &method.program {
        Program::Command(words) => Some(words),
        Program::Function => None,
    };
    let groups: Vec<&str> = method.groups.iter().map(|group| group.name()).collect();
    json!({ "name": name, "command": command, "parameters": groups, "version": versions.get(place) })
}
