//! The comparison in words.

use super::judge::{CellDifferences, Comparison, Judged, Measure, Verdict};
use super::versions::Version;
use std::fmt::Write;
use switchback_io::output::{columns, wrapped};

/// Alarms and improvements listed at most; the rest is counted.
const MOST: usize = 12;

/// What came out, ending with a newline.
pub fn words(
    comparison: &Comparison,
    (scenario, seed): (&str, u64),
    [baseline, new]: &[Version; 2],
) -> String {
    let width = baseline.name.chars().count().max(new.name.chars().count());
    let mut text = format!(
        "baseline  {:width$}  {}\nnew       {:width$}  {}\n{scenario}, seed {seed}: {} replicates of {} {}, both on the same noise; {} differences\n\n",
        baseline.name,
        baseline.version,
        new.name,
        new.version,
        comparison.replicates,
        comparison.cells.len(),
        if comparison.cells.len() == 1 { "cell" } else { "cells" },
        comparison.family,
    );
    text.push_str(&columns(&table(comparison)));
    text.push('\n');
    listed(&mut text, comparison, Verdict::Worse);
    listed(&mut text, comparison, Verdict::Better);
    reasons(&mut text, comparison);
    text.push_str(&wrapped(&conclusion(comparison), ""));
    text.trim_end().to_owned() + "\n"
}

fn table(comparison: &Comparison) -> Vec<[String; 6]> {
    let head = ["new less baseline", "largest", "at", "limit", "found from", "verdict"];
    let row = |measure: Measure| {
        let largest = comparison.largest(measure);
        let figures = largest.map_or(["–"; 4].map(str::to_owned), |(cell, parameter, judged)| {
            [
                figure(measure, judged),
                place(cell, parameter),
                amount(measure, judged.limit),
                amount(measure, judged.found_from),
            ]
        });
        let [value, at, limit, found_from] = figures;
        [named(measure), value, at, limit, found_from, comparison.verdict_on(measure).name().to_owned()]
    };
    [head.map(str::to_owned)].into_iter().chain(Measure::ALL.map(row)).collect()
}

fn named(measure: Measure) -> String {
    let unit = match measure {
        Measure::Bias => "sd of the baseline",
        Measure::Sd | Measure::Failures => "%",
    };
    format!("{} [{unit}]", measure.name())
}

/// A figure in the unit that words give it: of a logarithm of a ratio, the ratio less one in per cent.
fn scaled(measure: Measure, x: f64) -> f64 {
    match measure {
        Measure::Bias => x,
        Measure::Sd => 100.0 * x.exp_m1(),
        Measure::Failures => 100.0 * x,
    }
}

fn amount(measure: Measure, x: f64) -> String {
    if x.is_finite() { digits(scaled(measure, x)) } else { "–".to_owned() }
}

/// Two significant digits.
fn digits(x: f64) -> String {
    let decimals = if x == 0.0 { 0 } else { (1.0 - x.abs().log10().floor()).clamp(0.0, 6.0) as usize };
    format!("{x:.decimals$}")
}

fn figure(measure: Measure, judged: Judged) -> String {
    let value = scaled(measure, judged.value);
    let steepness = if measure == Measure::Sd { judged.value.exp() } else { 1.0 };
    let se = steepness * if measure == Measure::Bias { judged.se } else { 100.0 * judged.se };
    if !value.is_finite() || !se.is_finite() {
        return "not finite".to_owned();
    }
    let sign = match value {
        0.0 => "",
        _ if value.abs() < 1e-6 && se < 1e-6 => return "below 1e-6".to_owned(),
        _ if value < 0.0 => "−",
        _ => "+",
    };
    if se == 0.0 {
        format!("{sign}{}", digits(value.abs()))
    } else {
        format!("{sign}{} ± {}", digits(value.abs()), digits(se))
    }
}

/// Which parameter in which cell.
pub(super) fn place(cell: &CellDifferences, parameter: Option<&str>) -> String {
    let series = &cell.series;
    let parameter = parameter.map_or_else(String::new, |name| format!("{name}, "));
    format!(
        "{parameter}N = {}, {}, {}, m = {}, noise {}",
        cell.samples, series.case, series.border, series.points, series.noise
    )
}

fn listed(text: &mut String, comparison: &Comparison, verdict: Verdict) {
    let of = |measure: Measure| {
        let chosen = comparison.all(measure).filter(move |(.., judged)| judged.verdict == verdict);
        chosen.map(move |(cell, parameter, judged)| (measure, cell, parameter, judged))
    };
    let all: Vec<_> = Measure::ALL.into_iter().flat_map(of).collect();
    if all.is_empty() {
        return;
    }
    let _ = writeln!(text, "{} {}:", all.len(), verdict.name());
    for (measure, cell, parameter, judged) in all.iter().take(MOST) {
        let _ = writeln!(
            text,
            "  {} {} of {}",
            named(*measure),
            figure(*measure, *judged),
            place(cell, *parameter)
        );
    }
    if all.len() > MOST {
        let _ = writeln!(text, "  … and {} more", all.len() - MOST);
    }
    text.push('\n');
}

/// How many replicates have no estimate, where some have none.
fn reasons(text: &mut String, comparison: &Comparison) {
    let total = |of: fn(&CellDifferences) -> usize| comparison.cells.iter().map(of).sum::<usize>();
    let (baseline, new) = (total(|cell| cell.failures.baseline), total(|cell| cell.failures.new));
    if baseline + new == 0 {
        return;
    }
    let all = comparison.cells.len() * comparison.replicates as usize;
    let _ = writeln!(
        text,
        "without an estimate: {baseline} of {all} replicates of the baseline, {new} of the new version; the rest is compared"
    );
    if let Some(reason) = comparison.cells.iter().find_map(|cell| cell.failures.reason.as_ref()) {
        let _ = writeln!(text, "the new version said: {reason}");
    }
    text.push('\n');
}

fn conclusion(comparison: &Comparison) -> String {
    let limits = comparison.limits;
    match comparison.verdict() {
        Verdict::Worse => "ALARM: the new version is worse.".to_owned(),
        Verdict::Better => "No alarm: where the new version differs beyond a limit it is better.".to_owned(),
        Verdict::Equivalent => format!(
            "Equivalent: no bias differs by {} standard deviations, no standard deviation by {} %, no share of failures by {} %.",
            limits.bias,
            digits(100.0 * limits.sd.exp_m1()),
            digits(100.0 * limits.failures)
        ),
        Verdict::Undecided => {
            let wanted = |measure: Measure| {
                let undecided = comparison.verdict_on(measure) == Verdict::Undecided;
                comparison.replicates_that_find(measure).filter(|_| undecided && measure != Measure::Failures)
            };
            let most = Measure::ALL.into_iter().filter_map(wanted).max_by(f64::total_cmp);
            let remedy = most.filter(|count| *count > f64::from(comparison.replicates)).map_or_else(
                || "more replicates would tell".to_owned(),
                |count| format!("{count} replicates would tell"),
            );
            format!("No alarm, but the two are not shown to be equivalent: {remedy}.")
        }
    }
}
