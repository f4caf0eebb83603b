//! How long a replicate takes, before it is run.

use crate::scenario::{Case, Coupling, Engine, ForeignMethod, Scenario};
use switchback_identify::Method;

/// Seconds of one thread for a sample of noise of one experiment, drawn and taken in by the pulse methods: 0.139 ms a replicate of 100,000
/// samples in reports/speed.
const PULSES: f64 = 1.4e-9;

/// Seconds of one thread for a parameter of a cell of the pulse methods, solved for and added up: 0.84 s for 500 replicates of the 648 cells of
/// scenarios/leafspring.toml, less the noise.
const SOLVED: f64 = 0.1e-6;

/// Seconds of one thread for a sample of a cell of `free`: 53 ns in scenarios/any-record.toml, seven times as many where knots are refined.
const FREE: f64 = 50e-9;

/// Seconds of one thread for a question to a method of others: one that is quick.
const ASKED: f64 = 0.5e-3;

/// Seconds of one thread for a sample of a record in the open.
const OPEN: f64 = 20e-9;

/// The same of one replicate.
pub(super) fn of_a_replicate(scenario: &Scenario) -> f64 {
    scenario.cases().iter().map(|case| of_case(scenario, case)).sum()
}

/// The same of one replicate of a case.
fn of_case(scenario: &Scenario, case: &Case) -> f64 {
    let sweep = scenario.sweep();
    let longest = sweep.samples.last().map_or(0.0, |n| *n as f64);
    let series = (case.borders.len() * sweep.noise.len() * sweep.points.len()) as f64;
    let samples = series * sweep.samples.iter().map(|n| *n as f64).sum::<f64>();
    let pulse_methods = sweep.methods.iter().filter(|method| **method != Method::Free).count();
    let cells = series * sweep.samples.len() as f64 * pulse_methods as f64;
    let parameters = 2.0 * case.order as f64 + mean(&sweep.points) * 2.0;
    let pulses = match (pulse_methods, scenario.engine(), scenario.coupling()) {
        (0, ..) => 0.0,
        (_, Engine::Superposed, Coupling::Shared) => longest,
        (methods, ..) => samples * methods as f64,
    };
    let free = if sweep.methods.contains(&Method::Free) { samples } else { 0.0 };
    let asked = |method: &ForeignMethod| if method.antithetic { 2.0 } else { 1.0 };
    let asked = scenario.foreign().iter().map(asked).sum::<f64>();
    let foreign = asked * (ASKED * series * sweep.samples.len() as f64 + OPEN * samples);
    PULSES * pulses + SOLVED * cells * parameters + FREE * free + foreign
}

fn mean(points: &[usize]) -> f64 {
    points.iter().sum::<usize>() as f64 / points.len().max(1) as f64
}
