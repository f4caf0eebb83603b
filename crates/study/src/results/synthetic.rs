//! A made-up table that follows the laws of theory, so that figures and reports can be tried without an engine.

use super::*;
use crate::scenario::Engine;
use statrs::distribution::{ContinuousCDF, Normal};
use switchback_identify::Method;
use switchback_identify::statistics::CLASS_ENDS;

/// Two leaf springs, three methods (one of them inconsistent), two `m`, two noise levels, five `N`.
pub fn results() -> Results {
    let borders = ["constant stiffness", "hardening stiffness"];
    let methods = [Method::PaperDescendant, Method::Joint, Method::Memoryless];
    let mut cells = Vec::new();
    for (border, method) in borders.into_iter().flat_map(|b| methods.map(|m| (b, m))) {
        for (points, noise) in [4, 8].into_iter().flat_map(|m| [0.02, 0.1, 0.5].map(|s| (m, s))) {
            let case = "all assumptions hold".to_owned();
            let series = Series { case, border: border.to_owned(), method: method.into(), points, noise };
            for samples in [1_000, 3_000, 10_000, 30_000, 100_000] {
                cells.push(cell(&series, samples));
            }
        }
    }
    let mut results = Results {
        schema: SCHEMA,
        study: "consistency".to_owned(),
        name: "synthetic".to_owned(),
        question: "Do the figures show what the table holds?".to_owned(),
        seed: 1,
        version: "0.1.0".to_owned(),
        command: "switchback scenarios/synthetic.toml".to_owned(),
        partial: None,
        digits: None,
        engine: Engine::Superposed,
        coupling: Coupling::Shared,
        slope_samples: vec![1_000, 3_000, 10_000, 30_000, 100_000],
        labels: Labels { input: "deflection [mm]".to_owned(), output: "displacement [mm]".to_owned() },
        scenario: serde_json::json!({ "sweep": { "noise": [0.02, 0.1, 0.5] } }),
        curves: borders.iter().map(|b| curve(b)).collect(),
        expectations: vec![
            Expectation {
                what: "joint is consistent".to_owned(),
                held: true,
                detail: "24 of 24 verdicts".to_owned(),
            },
            Expectation {
                what: "memoryless is inconsistent".to_owned(),
                held: false,
                detail: "23 of 24 verdicts; undecided: hardening stiffness, m = 4, noise 0.5, a".to_owned(),
            },
        ],
        summaries: Vec::new(),
        paired: None,
        cells,
    };
    results.paired = Some(pairing(&results.cells));
    results.summaries = results.series().into_iter().flat_map(summaries).collect();
    results
}

const REPLICATES: f64 = 500.0;

fn truth(border: &str, v: f64, sign: f64) -> f64 {
    let hard = if border.starts_with('h') { 1e-3 } else { 0.0 };
    let force = |x: f64, s: f64| (0.2 + hard * x * x) * x + 0.8 * s;
    force(v, sign) / (force(20.0, 1.0) - force(-20.0, -1.0))
}

fn curve(border: &str) -> BorderCurve {
    let at = |i: i32| {
        let v = f64::from(i) - 20.0;
        CurvePoint { v, descending: truth(border, v, -1.0), ascending: truth(border, v, 1.0) }
    };
    BorderCurve {
        case: "all assumptions hold".to_owned(),
        border: border.to_owned(),
        points: (0..=40).map(at).collect(),
    }
}

/// Repeatable scatter in `(−1, 1)`.
fn scatter(seed: usize) -> f64 {
    let x = (seed as f64 * 12.9898 + 78.233).sin() * 43_758.547;
    2.0 * (x - x.floor()) - 1.0
}

fn cell(series: &Series, samples: usize) -> Cell {
    let sees = |group| series.method != Method::PaperDescendant || group != Group::Ascending;
    let m = series.points;
    let level = |j: usize| -20.0 + 40.0 * (j as f64) / (m as f64);
    let mut parameters = Vec::new();
    for (i, (name, value)) in [("a1", -1.2), ("a2", 0.5)].into_iter().enumerate() {
        parameters.push(parameter(series, samples, (Group::A, name.to_owned(), None, value), i));
    }
    for (i, (name, value)) in [("b1", 2.88), ("b2", 1.92)].into_iter().enumerate() {
        parameters.push(parameter(series, samples, (Group::B, name.to_owned(), None, value), 10 + i));
    }
    for (group, sign, label) in [(Group::Descending, -1.0, "desc"), (Group::Ascending, 1.0, "asc")] {
        if sees(group) {
            for j in 0..m {
                let v = if sign < 0.0 { level(j) } else { -level(j) };
                let what = (group, format!("F_{label}(V{})", j + 1), Some(v), truth(&series.border, v, sign));
                parameters.push(parameter(series, samples, what, 20 + j));
            }
        }
    }
    let failures = match (series.method == Method::Memoryless, samples) {
        (true, 1_000) => Failures {
            count: 2,
            replicates: vec![17, 203],
            reason: Some("the normal matrix is singular".to_owned()),
            reasons: Vec::new(),
        },
        _ => Failures::default(),
    };
    let replicates = REPLICATES as usize;
    let intervals =
        Group::ALL.into_iter().filter(|g| sees(*g)).map(|g| intervals(g, series, samples)).collect();
    Cell {
        series: series.clone(),
        samples,
        strong_id: None,
        replicates,
        precise: None,
        failures,
        intervals,
        parameters,
    }
}

/// Of an estimate that is normal about the truth, or about a wrong value.
fn intervals(group: Group, series: &Series, samples: usize) -> Intervals {
    let wrong =
        if series.method == Method::Memoryless { 0.04 / series.noise * (samples as f64).sqrt() } else { 0.0 };
    let up_to = |z: f64| Normal::new(wrong, 1.0).expect("a distribution").cdf(z);
    let end =
        |k: usize| 1.96 * if k == 0 { 0.0 } else { CLASS_ENDS.get(k - 1).copied().unwrap_or(f64::INFINITY) };
    let counted = |share: f64| (REPLICATES * share).round() as u32;
    Intervals {
        group,
        below: std::array::from_fn(|k| counted(up_to(-end(k)) - up_to(-end(k + 1)))),
        above: std::array::from_fn(|k| counted(up_to(end(k + 1)) - up_to(end(k)))),
    }
}

fn parameter(
    series: &Series,
    samples: usize,
    (group, name, v, truth): (Group, String, Option<f64>, f64),
    index: usize,
) -> Parameter {
    let n = samples as f64;
    let theory = series.noise / n.sqrt() * (1.0 + 0.3 * (index % 10) as f64);
    let wobble = scatter(index + samples + series.points);
    let sd = theory * (1.0 + wobble * 0.03);
    let mcse = sd / REPLICATES.sqrt();
    let plateau = if series.method == Method::Memoryless { 0.04 } else { 0.0 };
    let true_bias = plateau + 20.0 * series.noise * series.noise / n;
    let bias = true_bias + wobble * 1.5 * mcse;
    let controlled = series.method == Method::Joint;
    let coverage = if plateau > 0.0 { 0.1 } else { 0.95 + 0.01 * wobble };
    Parameter {
        name,
        group,
        v,
        truth,
        mean_estimate: Some(truth + bias),
        bias: Measured::new(bias, mcse),
        bias_controlled: controlled.then(|| Measured::new(true_bias, mcse / n.sqrt())).flatten(),
        sd: Measured::new(sd, sd / (2.0 * REPLICATES).sqrt()),
        sd_controlled: controlled.then(|| Measured::new(theory, theory / n.sqrt())).flatten(),
        mse: Measured::new(sd * sd + bias * bias, sd * sd * (2.0 / REPLICATES).sqrt()),
        coverage: Measured::new(coverage, (coverage * (1.0 - coverage) / REPLICATES).sqrt()),
        interval_score: None,
        coverage_bias_eliminated: None,
        coverage_controlled: controlled.then(|| Measured::new(0.95, 0.001)).flatten(),
        model_sd: Measured::new(theory, theory / 300.0),
        model_sd_relative_error: Measured::new(theory / sd - 1.0, 1.0 / (2.0 * REPLICATES).sqrt()),
        theory_bias: (plateau == 0.0).then_some(true_bias),
        theory_sd: (plateau == 0.0).then_some(theory),
        bound_sd: Some(theory * 0.8),
    }
}

/// Each cell over the same of the first method, and of the first border.
fn pairing(cells: &[Cell]) -> Pairing {
    let ratio = |over: &Parameter, of: &Parameter| {
        let variance = |p: &Parameter| p.sd.map_or(f64::NAN, |sd| sd.value().powi(2));
        let value = variance(of) / variance(over);
        Paired::new(value, 0.02 * value, 0.06 * value).expect("finite")
    };
    let mut pairing = Pairing::default();
    for cell in cells {
        let find = |series: &Series| cells.iter().find(|c| c.series == *series && c.samples == cell.samples);
        let method = Series { method: Method::PaperDescendant.into(), ..cell.series.clone() };
        let border = Series { border: cells[0].series.border.clone(), ..cell.series.clone() };
        for over in [method, border].into_iter().filter(|over| *over != cell.series) {
            let other = find(&over).expect("every method and border has every cell");
            let pairs = || cell.parameters.iter().filter_map(|of| Some((other.find(&of.name)?, of)));
            let at = pairing.comparisons.iter().position(|c| c.series == cell.series && c.over == over);
            let at = at.unwrap_or_else(|| {
                let (series, groups, parameters) = (cell.series.clone(), Vec::new(), Vec::new());
                pairing.comparisons.push(Comparison { series, over, groups, samples: 100_000, parameters });
                pairing.comparisons.len() - 1
            });
            let of_group = |group| {
                let (over, of) = pairs().find(|(o, _)| o.group == group)?;
                let (variance_ratio, samples) = (ratio(over, of), cell.samples);
                Some(PairedGroup {
                    samples,
                    group,
                    variance_ratio,
                    variance_ratio_controlled: None,
                    mse_ratio: variance_ratio,
                })
            };
            pairing.comparisons[at].groups.extend(Group::ALL.into_iter().filter_map(of_group));
            if cell.samples == 100_000 {
                pairing.comparisons[at].parameters.extend(pairs().map(|(over, of)| PairedParameter {
                    name: of.name.clone(),
                    variance_ratio: ratio(over, of),
                    variance_ratio_controlled: None,
                    mse_ratio: ratio(over, of),
                    bias_difference: Paired::new(1e-5, 2e-6, 2e-5).expect("finite"),
                }));
            }
        }
    }
    let overall = |subject, over: &str| Overall {
        case: "all assumptions hold".to_owned(),
        subject,
        over: vec![over.to_owned()],
        samples: 100_000,
        parameters: 24,
        variance_ratio: Paired::new(0.712, 0.005, 0.04).expect("finite"),
        variance_ratio_controlled: Paired::new(0.7154, 0.0003, 0.0004),
        mse_ratio: Paired::new(0.713, 0.005, 0.04).expect("finite"),
    };
    pairing.overall = vec![
        overall(Subject::Method(Method::Joint.into()), "paper-descendant"),
        overall(Subject::Border("hardening stiffness".to_owned()), "constant stiffness"),
    ];
    pairing
}

fn summaries(series: &Series) -> Vec<Summary> {
    let consistent = series.method != Method::Memoryless;
    let groups = Group::ALL
        .into_iter()
        .filter(|g| series.method != Method::PaperDescendant || *g != Group::Ascending)
        .collect::<Vec<_>>();
    let one = |group| Summary {
        series: series.clone(),
        group,
        sd_slope: Fitted::new(-0.5, (-0.512, -0.487)),
        sd_slope_theory: consistent.then_some(-0.5),
        bias_slope_theory: consistent.then_some(-1.0),
        bias_slope: if consistent { Fitted::new(-0.99, (-1.08, -0.9)) } else { None },
        bias_slope_samples: if consistent { vec![1_000, 3_000, 10_000] } else { Vec::new() },
        plateau: Fitted::new(if consistent { 0.0 } else { 0.04 }, (-0.001, 0.041)),
        coverage: Measured::new(if consistent { 0.951 } else { 0.1 }, 0.006),
        sd_over_theory: if consistent { Measured::new(1.004, 0.012) } else { None },
        variance_over_bound: Measured::new(1.56, 0.04),
        verdict: if consistent { Verdict::Consistent } else { Verdict::Inconsistent },
        reason: if consistent { "bias falls, sd falls" } else { "a bias of 0.040 remains" }.to_owned(),
    };
    groups.into_iter().map(one).collect()
}
