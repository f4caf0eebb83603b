//! A plan reported to a person.

use super::{Outlook, Plan, Prediction, RELIABLE_PERIODS, Report};
use std::fmt::Write;
use switchback_io::diagnosis::digits;
use switchback_io::identification::unit;
use switchback_io::output::columns;
use switchback_io::rig::RIG_FILE;

/// Lengths shown beside each other: each has four times the samples of the one before and half its errors.
const LENGTHS: usize = 5;

/// The answer, the predicted errors, the records to play, what the actuator must do, and what to do next.
pub fn words(report: &Report) -> String {
    let mut page = String::new();
    if let Some(outlook) = &report.outlook {
        page.push_str(&foreseen(&report.plan, outlook));
        page.push('\n');
    }
    page.push_str(&records(&report.plan));
    page.push('\n');
    page.push_str(&demands(&report.plan));
    if let Some(folder) = &report.folder {
        let _ = writeln!(
            page,
            "\nwritten to {folder}\nplay the column v of each file, add the measured y as a column, then: switchback identify \
             {folder}/{RIG_FILE}"
        );
    } else {
        page.push_str("\nnothing was written; `--out DIR` writes these records\n");
    }
    page
}

fn foreseen(plan: &Plan, outlook: &Outlook) -> String {
    let Outlook { truth, forecast, wanted } = outlook;
    let output = with_unit(&plan.request().labels[1]);
    let mut page = format!(
        "{}: identified by {}, order {}, noise sd {}{output}\n\n",
        truth.rig,
        truth.method,
        truth.system.order(),
        digits(truth.noise_sd, 3),
    );
    let chosen = plan.dataset().periods();
    page.push_str(&errors(plan, outlook));
    let _ = writeln!(
        page,
        "standard errors that the method {} will have; a point of a border as a share of u_M − u_m, b in{} for u_M − u_m = 1",
        forecast.method().name(),
        if output.is_empty() { " output units" } else { &output }
    );
    let at = forecast.at(chosen);
    let length = format!(
        "{chosen} periods, N = {} samples, {} for each pulse experiment, {} for all records",
        at.samples,
        duration(plan.seconds(at.samples)),
        duration(plan.seconds(plan.dataset().total())),
    );
    let worst = percent(at.errors.worst());
    let _ = match wanted {
        Some(wanted) => writeln!(
            page,
            "\nto know every border point to {} of u_M − u_m: {length} (predicted {worst})",
            percent(*wanted)
        ),
        None => writeln!(page, "\n{length}: the worst border point will be known to {worst} of u_M − u_m"),
    };
    if wanted.is_some() && chosen == RELIABLE_PERIODS {
        let _ = writeln!(
            page,
            "note: no fewer than {RELIABLE_PERIODS} periods are planned; with fewer, such predictions do not hold"
        );
    }
    for note in &truth.notes {
        let _ = writeln!(page, "note: {note}");
    }
    page.push_str(
        "note: the prediction takes the noise as white in the equation and as large as it was on this rig\n",
    );
    page
}

/// A table of the errors of every parameter against the length.
fn errors(plan: &Plan, outlook: &Outlook) -> String {
    let forecast = &outlook.forecast;
    let chosen = plan.dataset().periods();
    let lengths = lengths(chosen);
    let predictions: Vec<Prediction> = lengths.iter().map(|periods| forecast.at(*periods)).collect();
    let row = |name: String, value: String, cell: &dyn Fn(&Prediction) -> String| {
        let mut row: [String; LENGTHS + 2] = Default::default();
        (row[0], row[1]) = (name, value);
        row[2..].iter_mut().zip(&predictions).for_each(|(place, p)| *place = cell(p));
        row
    };
    let mut rows = vec![
        row("N".to_owned(), "estimate".to_owned(), &|p| p.samples.to_string()),
        row("each pulse experiment".to_owned(), String::new(), &|p| duration(plan.seconds(p.samples))),
    ];
    let planned = forecast.planned();
    let at = forecast.at(chosen).errors;
    for (i, a) in planned.a.iter().enumerate() {
        rows.push(row(format!("a{}", i + 1), carried(a.value, at.a[i]), &|p| digits(p.errors.a[i], 2)));
    }
    let output = with_unit(&plan.request().labels[1]);
    for (i, b) in planned.b.iter().enumerate() {
        rows.push(row(format!("b{}{output}", i + 1), carried(b.value, at.b[i]), &|p| {
            digits(p.errors.b[i], 2)
        }));
    }
    let worst = |errors: &[f64]| percent(errors.iter().copied().fold(0.0, f64::max));
    rows.push(row("worst descending point".to_owned(), String::new(), &|p| worst(&p.errors.descending)));
    rows.push(row("worst ascending point".to_owned(), String::new(), &|p| worst(&p.errors.ascending)));
    columns(&rows)
}

/// The length chosen in the middle of a ladder, or at its foot where shorter ones cannot be.
pub(super) fn lengths(chosen: usize) -> [usize; LENGTHS] {
    let fewest = switchback_identify::excitation::Dataset::FEWEST_PERIODS;
    let shorter = (0..=2).rev().find(|k| chosen / 4usize.pow(*k) >= fewest).unwrap_or(0);
    std::array::from_fn(|k| match (k as u32).checked_sub(shorter) {
        Some(up) => chosen.saturating_mul(4usize.pow(up)),
        None => chosen / 4usize.pow(shorter - k as u32),
    })
}

fn records(plan: &Plan) -> String {
    let mut rows = vec![["file", "role", "use", "samples", "duration"].map(str::to_owned)];
    for record in plan.records() {
        rows.push([
            format!("{}.csv", record.name),
            record.role.name().to_owned(),
            record.usage.name().to_owned(),
            record.v.len().to_string(),
            duration(plan.seconds(record.v.len())),
        ]);
    }
    let total: usize = plan.records().iter().map(|record| record.v.len()).sum();
    let all = [String::new(), String::new(), String::new(), total.to_string(), duration(plan.seconds(total))];
    rows.push(all);
    columns(&rows)
}

/// What the periods are made of, and what the actuator must be able to do.
fn demands(plan: &Plan) -> String {
    let request = plan.request();
    let (input, pulses) = (unit(&request.labels[0]), &plan.dataset().pulses()[0]);
    let spaced = if input.is_empty() { String::new() } else { format!(" {input}") };
    let a_second = if input.is_empty() { "/s".to_owned() } else { format!(" {input}/s") };
    let fastest = |records: &[switchback_identify::excitation::PlannedRecord]| {
        let steps = records.iter().flat_map(|record| record.v.windows(2)).map(|w| (w[1] - w[0]).abs());
        steps.fold(0.0, f64::max)
    };
    let all = plan.records();
    let mut page = String::new();
    if !request.free_only {
        let _ = writeln!(
            page,
            "a period of the pulse experiments has {} samples: {}, visited for one sample each, {} samples apart\n\
             the first of the {} periods lets the output settle",
            pulses.period(),
            counted(pulses.points(), "level"),
            pulses.spacing(),
            plan.dataset().periods(),
        );
        page.push_str(
            "each record begins with one sample at the other end: the move from there loads a known border\n",
        );
    }
    let step = fastest(&all);
    let _ = writeln!(
        page,
        "the actuator must move {}{spaced} within one sample ({}), at {}{a_second}",
        digits(step, 4),
        duration(request.sample_time),
        digits(step / request.sample_time, 4),
    );
    page
}

/// `1 level`, `2 levels`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

fn with_unit(label: &str) -> String {
    match unit(label) {
        "" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// A value to the second digit of its error.
fn carried(value: f64, error: f64) -> String {
    if !(error.is_finite() && error > 0.0) {
        return digits(value, 4);
    }
    let decimals = (1.0 - error.log10().floor()).max(0.0) as usize;
    // Adding zero turns the −0 of rounding into 0.
    let rounded = format!("{value:.decimals$}").parse::<f64>().unwrap_or(value) + 0.0;
    format!("{rounded:.decimals$}").replace('-', "−")
}

/// A share in percent, two significant digits.
fn percent(share: f64) -> String {
    format!("{} %", digits(100.0 * share, 2))
}

/// Three digits and the unit that keeps them short.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{} ms", digits(1e3 * s, 3)),
        s if s < 120.0 => format!("{} s", digits(s, 3)),
        s if s < 7200.0 => format!("{} min", digits(s / 60.0, 3)),
        s if s < 172_800.0 => format!("{} h", digits(s / 3600.0, 3)),
        s => format!("{} d", digits(s / 86_400.0, 3)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_length_chosen_stands_among_others_that_can_be() {
        assert_eq!(lengths(100), [6, 25, 100, 400, 1600]);
        assert_eq!(lengths(20), [5, 20, 80, 320, 1280]);
        assert_eq!(lengths(3), [3, 12, 48, 192, 768]);
    }

    #[test]
    fn durations_keep_three_digits_and_a_handy_unit() {
        let reported = [0.01, 3.666, 100.0, 300.0, 10_000.0, 1e6].map(duration);
        assert_eq!(reported, ["10.0 ms", "3.67 s", "100 s", "5.00 min", "2.78 h", "11.6 d"]);
    }
}
