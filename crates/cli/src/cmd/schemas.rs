//! `switchback schemas`

use super::{consistency, replay, rig};
use crate::failure::{CommandResult, Outcome};
use schemars::Schema;
use serde_json::Value;
use switchback_io::output::print;
use switchback_io::{identification, model, provenance};
use switchback_lab::{plant, power, selftest};
use switchback_report::{diagnosis, simulation};
use switchback_study::{compare, design, foreign, results};
use switchback_versions as bench;

/// Print the JSON Schemas of all that the program writes, as one list.
#[derive(Debug, clap::Args)]
pub(crate) struct Args;

/// Prints them.
///
/// # Errors
/// Standard output that cannot be written.
pub(crate) fn run(_: &Args) -> CommandResult {
    let all: Vec<Value> = schemas().into_iter().map(Value::from).collect();
    print(&format!("{}\n", Value::from(all)))?;
    Ok(Outcome::Done)
}

/// Every schema; its title is the name and version of the layout.
fn schemas() -> Vec<Schema> {
    let [rig, rig_list] = rig::schemas();
    let [greeting, request, answer] = foreign::schemas();
    vec![
        bench::schema(),
        bench::history_schema(),
        compare::schema(),
        consistency::part_schema(),
        design::schema(),
        greeting,
        request,
        answer,
        diagnosis::schema(),
        identification::schema(),
        model::schema(),
        plant::schema(),
        power::schema(),
        provenance::schema(),
        replay::schema(),
        results::schema(),
        rig,
        rig_list,
        selftest::schema(),
        simulation::schema(),
    ]
}
