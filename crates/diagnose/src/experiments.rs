//! The record that would separate the rivals: T-optimality among a handful of inputs.
//!
//! For every input the rivals' free-run predictions are compared; the input whose least distance between any two rivals is
//! largest is proposed (Atkinson and Fedorov, "The design of experiments for discriminating between two rival models",
//! Biometrika 62, 1975, pp. 57–70).

use std::f64::consts::PI;

use switchback_model::rig::{Role, Usage};

use crate::attribution::explain::Hypothesis;
use crate::diagnosis::{ExperimentKind, NextExperiment};
use crate::records::dataset::{Dataset, ScaledRecord, WARM_UP};
use crate::records::motion::{Play, motions};
use crate::simulation::simulate::free_run;
use crate::verdict::answer::{Status, Verdict};

/// Samples of a proposed record.
const LENGTH: usize = 1500;

/// The best next record where rivals are left; `noise` is the variance of the noise in the output, dimensionless.
pub(crate) fn propose(
    dataset: &Dataset,
    verdict: &Verdict,
    singles: &[Hypothesis],
    noise: f64,
) -> Option<NextExperiment> {
    if !matches!(verdict.status, Status::Class | Status::Ambiguous | Status::Shortlist)
        || verdict.class.len() < 2
    {
        return None;
    }
    let rivals: Vec<&Hypothesis> = verdict
        .class
        .iter()
        .filter_map(|e| singles.iter().find(|s| s.effect_terms[0].effect == *e))
        .collect();
    // A rival that was not fitted makes no prediction.
    if rivals.len() < 2 {
        return None;
    }
    let scale = noise.max(1e-300).sqrt();
    let mut best: Option<NextExperiment> = None;
    for (kind, v) in inputs(dataset) {
        let scaled = ScaledRecord {
            name: kind.name().into(),
            role: Role::Free,
            usage: Usage::Holdout,
            y: vec![0.0; v.len()].into(),
            clock: dataset.total,
            before: dataset.scaled_records.len(),
            travelled: dataset.travel,
            period: None,
            from: WARM_UP.min(v.len()),
            moves: motions(&v, Play::default(), dataset.rule).into(),
            standing: false,
            v: v.into(),
        };
        let runs: Vec<Vec<f64>> =
            rivals.iter().map(|r| free_run(dataset, &r.fit, dataset.scaled_records.len(), &scaled)).collect();
        let mut least = f64::INFINITY;
        for i in 0..runs.len() {
            for j in 0..i {
                let square: f64 = runs[i].iter().zip(&runs[j]).map(|(x, y)| (x - y).powi(2)).sum();
                least = least.min((square / scaled.v.len() as f64).sqrt() / scale);
            }
        }
        if best.as_ref().is_none_or(|b| least > b.distance) {
            best = Some(NextExperiment {
                kind,
                v: scaled.v.iter().map(|v| dataset.v_low + dataset.v_width * v).collect(),
                separates: rivals.iter().map(|r| r.effect_terms[0].effect).collect(),
                distance: least,
            });
        }
    }
    best
}

/// The inputs to choose from, dimensionless.
fn inputs(dataset: &Dataset) -> Vec<(ExperimentKind, Vec<f64>)> {
    let n = LENGTH;
    // A triangle of period `p` between `low` and `high`.
    let triangle = |t: usize, p: f64| {
        let phase = (t as f64 / p).fract();
        if phase < 0.5 { 2.0 * phase } else { 2.0 - 2.0 * phase }
    };
    let pseudo_random = |k: usize| {
        // A linear congruential step is random enough for levels, and the same on every machine.
        let x = (k as u64).wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((x ^ (x >> 31)).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64 / (1u64 << 53) as f64
    };
    // Towards the next level at a pace, then at rest.
    let levels = |t: usize, held: usize, pace: f64, from: f64| {
        let (k, share) = (t / held, ((t % held) as f64 / pace).min(from));
        pseudo_random(k) + (pseudo_random(k + 1) - pseudo_random(k)) * share / from
    };
    let sweep = |t: usize| {
        let x = t as f64 / n as f64;
        0.5 + 0.5 * (2.0 * PI * (3.0 * x + 0.06 * n as f64 * x * x)).sin()
    };
    let rates = |t: usize| triangle(t % (n / 3), [200.0, 50.0, 12.5][(3 * t / n).min(2)]);
    let swing = |t: usize, width: f64| 0.5 + width * (triangle(t, 50.0) - 0.5);
    let all: [(ExperimentKind, &dyn Fn(usize) -> f64); 7] = [
        (ExperimentKind::NestedReversals, &|t| swing(t, 1.0 - (t % 500) as f64 / 520.0)),
        (ExperimentKind::RandomLevels, &|t| levels(t, 8, 8.0, 0.75)),
        (ExperimentKind::Sweep, &sweep),
        (ExperimentKind::SeveralRates, &rates),
        (ExperimentKind::Prbs, &|t| f64::from(u8::from(pseudo_random(t / 4) > 0.5))),
        (ExperimentKind::Rest, &|t| levels(t, 150, 10.0, 1.0)),
        (ExperimentKind::AmplitudeSeries, &|t| swing(t, 0.1 + 0.9 * (t / 100) as f64 / 14.0)),
    ];
    let mut out: Vec<_> = all.into_iter().map(|(kind, v)| (kind, (0..n).map(v).collect())).collect();
    if let Some(first) = dataset.fit().next() {
        out.push((ExperimentKind::RepeatOfFirst, first.v.iter().copied().take(2 * n).collect()));
    }
    out
}
