//! The identification as a page for a person.

use super::{Identification, lacks_holdout, unit};
use crate::output::columns;
use std::fmt::Write;
use switchback_estimator::estimators::{BorderPoint, Estimate};
use switchback_estimator::rig::{Rig, Usage};

/// Half-width of a 95 % interval in standard errors of a normal estimate.
const Z95: f64 = 1.959_963_984_540_054;

/// Parameters with 95 % intervals, the fit of every record, the borders, and what to beware of.
pub fn table(rig: &Rig, identification: &Identification) -> String {
    let mut page = headline(rig, identification);
    for part in [parameters(rig, &identification.estimate), fits(rig, identification)] {
        page.push('\n');
        page.push_str(&part);
    }
    if identification.has_borders() {
        page.push('\n');
        page.push_str(&borders(rig, identification));
    }
    if !identification.warnings.is_empty() || lacks_holdout(rig) {
        page.push('\n');
    }
    if lacks_holdout(rig) {
        page.push_str("warning: no record is held out, so the fit above is only a fit to what was fitted\n");
    }
    for warning in &identification.warnings {
        let _ = writeln!(page, "warning: {warning}");
    }
    page
}

fn headline(rig: &Rig, identification: &Identification) -> String {
    let estimate = &identification.estimate;
    // In the paper the output follows one sample after the input at the earliest; only another delay is worth a word.
    let delay = match estimate.delay {
        0 => String::new(),
        1 => ", 1 sample of extra delay".to_owned(),
        extra if extra > 1 => format!(", {extra} samples of extra delay"),
        -1 => ", with a direct term".to_owned(),
        -2 => ", looking 1 sample ahead".to_owned(),
        ahead => format!(", looking {} samples ahead", -1 - ahead),
    };
    format!(
        "{}: {}, order {}{delay}, {} samples of {} s\n",
        rig.name,
        identification.method,
        estimate.a.len(),
        estimate.samples,
        rig.sample_time
    )
}

fn parameters(rig: &Rig, estimate: &Estimate) -> String {
    let output = unit(&rig.output_label);
    let mut rows = vec![["parameter", "estimate", "95 % interval", "unit"].map(str::to_owned)];
    // A negative delay starts B at b₀ or before; a positive one shifts the whole of B and leaves its names alone.
    let first_b = 1 + estimate.delay.min(0);
    for (letter, first, values, errors, unit) in
        [("a", 1, &estimate.a, &estimate.a_se, ""), ("b", first_b, &estimate.b, &estimate.b_se, output)]
    {
        for (lag, (value, se)) in (first..).zip(values.iter().zip(errors)) {
            rows.push([format!("{letter}{lag}"), number(*value), plus_minus(*se), unit.to_owned()]);
        }
    }
    for (name, value) in [
        ("gain B(1)/A(1)", estimate.gain),
        ("y_high", estimate.y_high),
        ("y_low", estimate.y_low),
        ("noise sd", estimate.noise_sd),
    ] {
        rows.push([name.to_owned(), number(value), String::new(), output.to_owned()]);
    }
    rows.push(["excitation λ_min".to_owned(), number(estimate.excitation), String::new(), String::new()]);
    columns(&rows)
}

fn fits(rig: &Rig, identification: &Identification) -> String {
    let mut rows = vec![["record", "use", "samples", "fit % in free run"].map(str::to_owned)];
    for (record, run) in rig.records.iter().zip(&identification.runs) {
        let usage = match record.usage {
            Usage::Fit => "fit",
            Usage::Holdout => "hold-out",
        };
        let fit = match run {
            Some(run) if run.fit_percent.is_finite() => format!("{:.1}", run.fit_percent),
            _ => "–".to_owned(),
        };
        rows.push([record.name.clone(), usage.to_owned(), record.record.len().to_string(), fit]);
    }
    columns(&rows)
}

/// Both borders over one axis, where a cell stays empty if that border has no point there; one curve if they coincide.
fn borders(rig: &Rig, identification: &Identification) -> String {
    let estimate = &identification.estimate;
    let v = match unit(&rig.input_label) {
        "" => "v".to_owned(),
        unit => format!("v [{unit}]"),
    };
    let table = if identification.has_one_curve() {
        let points = estimate.descending.iter().map(|p| [number(p.v), number(p.f), plus_minus(p.se)]);
        let header = [v, "static curve".to_owned(), "95 %".to_owned()];
        columns(&std::iter::once(header).chain(points).collect::<Vec<_>>())
    } else {
        let mut positions: Vec<f64> =
            estimate.descending.iter().chain(&estimate.ascending).map(|point| point.v).collect();
        positions.sort_by(f64::total_cmp);
        positions.dedup();
        let at = |border: &[BorderPoint], v: f64| {
            let point = border.iter().find(|point| point.v == v);
            point.map_or([String::new(), String::new()], |point| [number(point.f), plus_minus(point.se)])
        };
        let mut rows =
            vec![[v, "descending border".into(), "95 %".into(), "ascending border".into(), "95 %".into()]];
        for v in positions {
            let [d, d_se] = at(&estimate.descending, v);
            let [a, a_se] = at(&estimate.ascending, v);
            rows.push([number(v), d, d_se, a, a_se]);
        }
        columns(&rows)
    };
    format!("{table}in units of u_M − u_m; times the gain these are stationary outputs\n")
}

/// Five significant digits: more than any record supports, few enough to compare by eye.
fn number(x: f64) -> String {
    if !x.is_finite() {
        return "–".to_owned();
    }
    let magnitude = if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 };
    if (-4..=6).contains(&magnitude) {
        format!("{x:.*}", usize::try_from(4 - magnitude).unwrap_or(0))
    } else {
        format!("{x:.4e}")
    }
}

fn plus_minus(se: f64) -> String {
    if !se.is_finite() {
        return "–".to_owned();
    }
    let half = Z95 * se;
    let magnitude = if half == 0.0 { 0 } else { half.log10().floor() as i32 };
    if (-4..=6).contains(&magnitude) {
        format!("± {half:.*}", usize::try_from(1 - magnitude).unwrap_or(0))
    } else {
        format!("± {half:.1e}")
    }
}
