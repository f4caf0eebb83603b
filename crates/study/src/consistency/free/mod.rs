//! The method `free`: no designed experiment, one random drive for all replicates.
//!
//! The drive (moves between random levels, with rests) is drawn once from the scenario's seed, scaled to each case's interval, and repeated
//! every `N₁` samples, `N₁` the smallest of `sweep.samples`; what differs between replicates is the noise. `sweep.points` is the number `m` of evenly spaced knots on each border, the ends of the interval
//! among them. Where a border is not piecewise linear on these knots the method does not hold the truth, and a bias stays.

mod cell_design;
mod drive;
mod noise_group;
mod simulate;

pub(super) use noise_group::FreeNoiseGroup;

use super::error::StudyError;
use crate::scenario::{Case, Coupling, Scenario, Sweep};
use drive::Program;
use noise_group::Design;
use switchback_identify::Method;

/// Noise streams from here on belong to this method, above all that pulse noise groups use.
const FIRST_STREAM: u32 = 1 << 31;

/// Lays out the noise groups of a scenario; none if the sweep does not have the method.
///
/// As for the pulse methods: with shared noise one noise group a case, all on the same stream; with independent noise one a cell, each with its own.
pub(super) fn plan(scenario: &Scenario) -> Result<Vec<FreeNoiseGroup>, StudyError> {
    let sweep = scenario.sweep();
    let mut groups = Vec::new();
    if !sweep.methods.contains(&Method::Free) {
        return Ok(groups);
    }
    let program = Program { seed: scenario.seed(), period: sweep.samples[0] };
    let design = Design { program, engine: scenario.engine() };
    for case in scenario.cases() {
        match scenario.coupling() {
            Coupling::Shared => groups.push(FreeNoiseGroup::new(case, sweep, FIRST_STREAM, design)?),
            Coupling::Independent => {
                for (case, sweep) in cells(case, sweep) {
                    let stream = FIRST_STREAM + groups.len() as u32;
                    groups.push(FreeNoiseGroup::new(&case, &sweep, stream, design)?);
                }
            }
        }
    }
    Ok(groups)
}

/// A case and a sweep for every cell.
fn cells(case: &Case, sweep: &Sweep) -> Vec<(Case, Sweep)> {
    let mut cells = Vec::new();
    for border in &case.borders {
        for &points in &sweep.points {
            for &noise in &sweep.noise {
                for &samples in &sweep.samples {
                    let methods = vec![Method::Free];
                    cells.push((
                        Case { borders: vec![border.clone()], ..case.clone() },
                        Sweep {
                            noise: vec![noise],
                            samples: vec![samples],
                            points: vec![points],
                            methods,
                            slope_from: samples,
                        },
                    ));
                }
            }
        }
    }
    cells
}
