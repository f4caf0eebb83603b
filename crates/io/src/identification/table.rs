//! The identification as a page for a person.

use super::{Identification, unit};
use crate::output::columns;
use std::fmt::Write;
use switchback_identify::statistics::Z95;
use switchback_identify::{BorderPoint, Coefficient, LevelErrors, PlusMinus};
use switchback_model::rig::{Rig, Usage};

/// What to beware of, then parameters with 95 % intervals, the fit of every record, and the borders.
pub fn table(rig: &Rig, identification: &Identification) -> String {
    let mut page = String::new();
    for flag in &identification.flags {
        let _ = writeln!(page, "warning: {}", flag.text);
    }
    if !identification.flags.is_empty() {
        page.push('\n');
    }
    page.push_str(&headline(rig, identification));
    for part in [parameters(rig, identification), fits(rig, identification)] {
        page.push('\n');
        page.push_str(&part);
    }
    if identification.has_borders() {
        page.push('\n');
        page.push_str(&borders(rig, identification));
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

fn parameters(rig: &Rig, identification: &Identification) -> String {
    let estimate = &identification.estimate;
    let unknown = LevelErrors { gain: f64::NAN, y_high: f64::NAN, y_low: f64::NAN };
    let errors = identification.level_errors.unwrap_or(unknown);
    let output = unit(&rig.output_label);
    let mut rows = vec![["parameter", "estimate", "95 % interval", "unit"].map(str::to_owned)];
    for coefficient in estimate.a_coefficients().chain(estimate.b_coefficients()) {
        let Coefficient { letter, lag, value, se } = coefficient;
        let [value, half] = rounded(value, Z95 * se);
        let unit = if letter == 'b' { output } else { "" };
        rows.push([format!("{letter}{lag}"), value, half, unit.to_owned()]);
    }
    // The error of a standard deviation, as of normal noise.
    let of_noise = Z95 * estimate.noise_sd / (2.0 * estimate.samples as f64).sqrt();
    for (name, value, half) in [
        ("gain B(1)/A(1)", estimate.gain, Z95 * errors.gain),
        ("y_high", estimate.y_high, Z95 * errors.y_high),
        ("y_low", estimate.y_low, Z95 * errors.y_low),
        ("noise sd", estimate.noise_sd, of_noise),
    ] {
        let [value, half] = rounded(value, half);
        rows.push([name.to_owned(), value, half, output.to_owned()]);
    }
    rows.push([
        "excitation λ_min".to_owned(),
        format!("{:.1e}", estimate.excitation),
        String::new(),
        String::new(),
    ]);
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
        let points = estimate.descending.iter().map(|p| {
            let [f, half] = rounded(p.f, Z95 * p.se);
            [number(p.v), f, half]
        });
        let header = [v, "static curve".to_owned(), "95 %".to_owned()];
        columns(&std::iter::once(header).chain(points).collect::<Vec<_>>())
    } else {
        let mut positions: Vec<f64> =
            estimate.descending.iter().chain(&estimate.ascending).map(|point| point.v).collect();
        positions.sort_by(f64::total_cmp);
        positions.dedup();
        let at = |border: &[BorderPoint], v: f64| {
            let point = border.iter().find(|point| point.v == v);
            point.map_or([String::new(), String::new()], |point| rounded(point.f, Z95 * point.se))
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
    let apart = identification.distance.map_or(String::new(), |distance| {
        format!(
            "the borders differ beyond their errors over {:.0} % of the stroke\n",
            100.0 * distance.distinguished
        )
    });
    format!("{table}in units of u_M − u_m; times the gain these are stationary outputs\n{apart}")
}

/// A known position: five significant digits.
fn number(x: f64) -> String {
    PlusMinus::new(x, f64::NAN).value
}

/// An estimate and the half-width of its 95 % interval, with no digits that the error does not leave; empty where there is no error.
fn rounded(value: f64, half: f64) -> [String; 2] {
    let PlusMinus { value, half } = PlusMinus::new(value, half);
    [value, if half == "–" { half } else { format!("± {half}") }]
}
