//! The JSON Schemas of all that the program writes.

use crate::cmd::{calibrate, consistency, replay, rig};
use schemars::Schema;
use switchback_io::{identification, model, provenance, simulation};
use switchback_lab::{plant, power, selftest};
use switchback_report::diagnosis;
use switchback_study::{compare, design, results};

/// Every schema; its title is the name and version of the layout.
pub fn schemas() -> Vec<Schema> {
    let [rig, rig_list] = rig::schemas();
    vec![
        calibrate::schema(),
        compare::schema(),
        consistency::part_schema(),
        design::schema(),
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
