//! From sums to the result table.

use super::cell::{CellSpec, CellTheory};
use super::sections::{CellSums, Runs};
use crate::results::{Cell, Failures, Group, Intervals, Measured, Parameter};
use rayon::prelude::*;
use switchback_identify::statistics::{self, ErrorSums, IntervalCounts};

/// One entry a cell, in their order.
pub(super) fn cells(
    specs: &[CellSpec],
    theories: &[CellTheory],
    totals: &[CellSums],
    precise: Option<&[bool]>,
) -> Vec<Cell> {
    specs
        .par_iter()
        .enumerate()
        .map(|(index, spec)| {
            let sums = totals[index].parameters(None);
            let runs = &totals[index].runs;
            let parameters =
                sums.iter().enumerate().map(|(k, sums)| parameter((spec, &theories[index]), k, sums));
            Cell {
                series: spec.series.clone(),
                samples: spec.samples,
                parameters: parameters.collect(),
                replicates: runs.replicates,
                precise: precise.map(|precise| precise[index]),
                intervals: intervals(spec, &totals[index]),
                failures: failures(runs),
            }
        })
        .collect()
}

/// One entry a group that has parameters.
fn intervals(spec: &CellSpec, total: &CellSums) -> Vec<Intervals> {
    let of_group = |group: Group| {
        let mut counts: Option<IntervalCounts> = None;
        for (_, more) in spec.parameters.iter().zip(total.intervals()).filter(|(p, _)| p.group == group) {
            counts.get_or_insert_default().merge(more);
        }
        counts.map(|counts| Intervals { group, below: counts.below, above: counts.above })
    };
    Group::ALL.into_iter().filter_map(of_group).collect()
}

fn failures(runs: &Runs) -> Failures {
    let reasons = runs.failures.iter().map(|failure| failure.reason.clone());
    let reason = reasons.clone().next();
    let all_the_same = reasons.clone().all(|other| Some(&other) == reason.as_ref());
    Failures {
        count: runs.failed,
        replicates: runs.failures.iter().map(|failure| failure.replicate).collect(),
        reasons: if all_the_same { Vec::new() } else { reasons.collect() },
        reason,
    }
}

fn parameter((spec, theory): (&CellSpec, &CellTheory), k: usize, sums: &ErrorSums) -> Parameter {
    let at = |values: &Option<Vec<f64>>| values.as_ref().map(|v| v[k]);
    let theory_sd = at(&theory.sd);
    let name = &spec.parameters[k];
    let performance = sums.performance(theory.known(k));
    let measured = |m: statistics::Measured| Measured::new(m.value, m.mcse);
    Parameter {
        name: name.name.clone(),
        group: name.group,
        v: name.v,
        truth: spec.truth[k],
        mean_estimate: performance.map(|p| spec.truth[k] + p.bias.value),
        bias: performance.and_then(|p| measured(p.bias)),
        bias_controlled: performance.and_then(|p| p.bias_controlled).and_then(measured),
        sd: performance.and_then(|p| measured(p.sd)),
        sd_controlled: performance.and_then(|p| p.sd_controlled).and_then(measured),
        mse: performance.and_then(|p| measured(p.mse)),
        coverage: performance.and_then(|p| measured(p.coverage)),
        coverage_controlled: performance.and_then(|p| p.coverage_controlled).and_then(measured),
        model_sd: performance.and_then(|p| measured(p.model_sd)),
        model_sd_relative_error: performance.and_then(|p| measured(p.model_sd_relative_error)),
        theory_bias: at(&theory.bias),
        theory_sd,
        bound_sd: at(&theory.bound),
    }
}
