//! From sums to the result table.

use super::cell::{CellSpec, CellTheory};
use super::sections::{CellSums, Runs};
use super::views::performances;
use crate::results::{Cell, Failures, Group, Intervals, Measured, Parameter};
use rayon::prelude::*;
use switchback_identify::statistics::{self, IntervalCounts, Performance};

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
            let runs = &totals[index].runs;
            let performances = performances(&theories[index], &totals[index], None);
            let intervals = intervals(spec, &totals[index], &performances);
            let estimates = runs.replicates - runs.failed;
            let foreign = totals[index].foreign().filter(|_| estimates > 1);
            let scores = foreign.map(|sums| sums.controls.interval_scores(estimates));
            let score = |k: usize| scores.as_ref().and_then(|scores| measured(scores[k]));
            // Around the mean estimate, where every estimate has an interval.
            let around_mean = |k: usize, performance: Option<Performance>| {
                let known = performance.filter(|p| p.model_sd.value.is_finite())?;
                measured(foreign?.ends[k].coverage(known.bias.value)?)
            };
            let parameters = performances.into_iter().enumerate().map(|(k, performance)| Parameter {
                interval_score: score(k),
                coverage_bias_eliminated: around_mean(k, performance),
                ..parameter((spec, &theories[index]), k, performance)
            });
            Cell {
                series: spec.series.clone(),
                samples: spec.samples,
                strong_id: None,
                parameters: parameters.collect(),
                replicates: runs.replicates,
                precise: precise.map(|precise| precise[index]),
                intervals,
                failures: failures(runs),
            }
        })
        .collect()
}

/// One entry a group that has parameters.
fn intervals(spec: &CellSpec, total: &CellSums, performances: &[Option<Performance>]) -> Vec<Intervals> {
    // Without standard errors there are no intervals.
    let has_errors = |k: usize| performances[k].is_none_or(|p| p.model_sd.value.is_finite());
    let of_group = |group: Group| {
        let mut counts: Option<IntervalCounts> = None;
        let of_parameters = spec.parameters.iter().zip(total.intervals()).enumerate();
        for (_, (_, more)) in of_parameters.filter(|(k, (p, _))| p.group == group && has_errors(*k)) {
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

fn measured(m: statistics::Measured) -> Option<Measured> {
    Measured::new(m.value, m.mcse)
}

fn parameter(
    (spec, theory): (&CellSpec, &CellTheory),
    k: usize,
    performance: Option<Performance>,
) -> Parameter {
    let at = |values: &Option<Vec<f64>>| values.as_ref().map(|v| v[k]);
    let theory_sd = at(&theory.sd);
    let name = &spec.parameters[k];
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
        interval_score: None,
        coverage_bias_eliminated: None,
        model_sd: performance.and_then(|p| measured(p.model_sd)),
        model_sd_relative_error: performance.and_then(|p| measured(p.model_sd_relative_error)),
        theory_bias: at(&theory.bias),
        theory_sd,
        bound_sd: at(&theory.bound),
    }
}
