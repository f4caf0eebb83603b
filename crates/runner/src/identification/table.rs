//! The identification as a page for a person.

use super::{Identification, has_borders, lacks_holdout, unit};
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
    if has_borders(identification) {
        page.push('\n');
        page.push_str(&borders(rig, &identification.estimate));
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
    let delay = match estimate.delay {
        0 => String::new(),
        1 => ", delay 1 sample".to_owned(),
        samples => format!(", delay {samples} samples"),
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
    for (letter, values, errors, unit) in
        [("a", &estimate.a, &estimate.a_se, ""), ("b", &estimate.b, &estimate.b_se, output)]
    {
        for (i, (value, se)) in values.iter().zip(errors).enumerate() {
            rows.push([format!("{letter}{}", i + 1), number(*value), plus_minus(*se), unit.to_owned()]);
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
    aligned(&rows)
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
    aligned(&rows)
}

/// Both borders over one axis: where only one was estimated, the other's cells stay empty.
fn borders(rig: &Rig, estimate: &Estimate) -> String {
    let mut positions: Vec<f64> =
        estimate.descending.iter().chain(&estimate.ascending).map(|point| point.v).collect();
    positions.sort_by(f64::total_cmp);
    positions.dedup();
    let at = |border: &[BorderPoint], v: f64| {
        let point = border.iter().find(|point| point.v == v);
        point.map_or([String::new(), String::new()], |point| [number(point.f), plus_minus(point.se)])
    };
    let v_header = match unit(&rig.input_label) {
        "" => "v".to_owned(),
        unit => format!("v [{unit}]"),
    };
    let mut rows = vec![[
        v_header,
        "descending border".to_owned(),
        "95 %".to_owned(),
        "ascending border".to_owned(),
        "95 %".to_owned(),
    ]];
    for v in positions {
        let [d, d_se] = at(&estimate.descending, v);
        let [a, a_se] = at(&estimate.ascending, v);
        rows.push([number(v), d, d_se, a, a_se]);
    }
    format!("{}borders in units of u_M − u_m; times the gain they are stationary outputs\n", aligned(&rows))
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

/// Columns padded to their widest cell: the first to the left, the others to the right, no blanks at the line's end.
fn aligned<const N: usize>(rows: &[[String; N]]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = format!("{:<width$}", row[0], width = widths[0]);
        for column in 1..N {
            let _ = write!(line, "  {:>width$}", row[column], width = widths[column]);
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}
