//! The method `free`: no designed experiment, one random drive for all replicates.
//!
//! The drive (moves between random levels, with rests) is drawn once from the scenario's seed, scaled to each case's interval, and repeated
//! every `N₁` samples, `N₁` the smallest of `sweep.samples`; what differs between replicates is the noise. `sweep.points` is the number `m` of evenly spaced knots on each border, the ends of the interval
//! among them. Where a border is not piecewise linear on these knots the method does not hold the truth, and a bias stays.

mod drive;
mod setting;
mod simulate;
mod world;

pub(super) use world::FreeWorld;

use super::StudyError;
use crate::scenario::{Case, Coupling, Method, Scenario, Sweep};
use drive::Program;
use world::Design;

/// Noise streams from here on belong to this method, above all that pulse worlds use.
const FIRST_STREAM: u32 = 1 << 31;

/// Lays out the worlds of a scenario; none if the sweep does not have the method.
///
/// As for the pulse methods: with shared noise one world a case, all on the same stream; with independent noise one a cell, each with its own.
pub(super) fn plan(scenario: &Scenario) -> Result<Vec<FreeWorld>, StudyError> {
    let sweep = scenario.sweep();
    let mut worlds = Vec::new();
    if !sweep.methods.contains(&Method::Free) {
        return Ok(worlds);
    }
    let program = Program { seed: scenario.seed(), period: sweep.samples[0] };
    let design = Design { program, engine: scenario.engine() };
    for case in scenario.cases() {
        match scenario.coupling() {
            Coupling::Shared => worlds.push(FreeWorld::new(case, sweep, FIRST_STREAM, design)?),
            Coupling::Independent => {
                for (case, sweep) in cells(case, sweep) {
                    let stream = FIRST_STREAM + worlds.len() as u32;
                    worlds.push(FreeWorld::new(&case, &sweep, stream, design)?);
                }
            }
        }
    }
    Ok(worlds)
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
