//! From sums to the result table.

use super::sections::Sections;
use super::world::{Contender, Setting, World};
use crate::results::{Cell, Failures, Measured, Parameter, Series};
use crate::scenario::Scenario;
use switchback_estimator::statistics::{self, ErrorSums};

/// The series that a cell belongs to.
pub(super) fn series(scenario: &Scenario, setting: &Setting, contender: &Contender) -> Series {
    let case = &scenario.cases()[setting.case];
    Series {
        case: case.name.clone(),
        border: case.borders[setting.border].name.clone(),
        method: contender.method,
        points: setting.bench.points,
        noise: setting.sigma,
    }
}

/// One entry a cell, in the order of the worlds.
pub(super) fn cells(scenario: &Scenario, worlds: &[World], sections: &Sections) -> Vec<Cell> {
    worlds
        .iter()
        .flat_map(World::cells)
        .enumerate()
        .map(|(index, (setting, samples, contender))| {
            let sums = sections.cell(index, None);
            let theory = contender.theory.then(|| contender.limit.theory_se(samples as f64));
            let bound = contender.bound.as_ref().map(|b| b.sd(samples as f64));
            let parameters = sums.parameters.iter().enumerate().map(|(k, parameter)| {
                let at = |values: &Option<Vec<f64>>| values.as_ref().map(|v| v[k]);
                self::parameter(contender, k, parameter, at(&theory), at(&bound))
            });
            Cell {
                series: series(scenario, setting, contender),
                samples,
                parameters: parameters.collect(),
                replicates: sums.replicates,
                failures: Failures { count: sums.failed, replicates: sums.failures, reason: sums.reason },
            }
        })
        .collect()
}

fn parameter(
    contender: &Contender,
    k: usize,
    sums: &ErrorSums,
    theory_sd: Option<f64>,
    bound_sd: Option<f64>,
) -> Parameter {
    let name = &contender.parameters[k];
    let performance = sums.performance(theory_sd.map(|sd| sd * sd));
    let measured = |m: statistics::Measured| Measured::new(m.value, m.mcse);
    Parameter {
        name: name.name.clone(),
        group: name.group,
        v: name.v,
        truth: contender.truth[k],
        mean_estimate: performance.map(|p| contender.truth[k] + p.bias.value),
        bias: performance.and_then(|p| measured(p.bias)),
        bias_controlled: performance.and_then(|p| p.bias_controlled).and_then(measured),
        sd: performance.and_then(|p| measured(p.sd)),
        sd_controlled: performance.and_then(|p| p.sd_controlled).and_then(measured),
        mse: performance.and_then(|p| measured(p.mse)),
        coverage: performance.and_then(|p| measured(p.coverage)),
        model_sd: performance.and_then(|p| measured(p.model_sd)),
        model_sd_relative_error: performance.and_then(|p| measured(p.model_sd_relative_error)),
        theory_sd,
        bound_sd,
    }
}
