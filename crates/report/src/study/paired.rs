//! What methods and borders are to each other on the same noise, in a few lines.

use statrs::distribution::{ContinuousCDF, StudentsT};
use switchback_study::results::{Overall, Paired, Results};

/// More lines than this are left to `results.json`.
const LINES: usize = 16;

/// Degrees of freedom behind the errors of ratios: sections of replicates less one.
const FREEDOM: f64 = 19.0;

/// A line a method or border, under a heading; nothing where cells do not share their noise or there is but one of each.
pub(super) fn lines(results: &Results) -> String {
    let overall = results.paired.as_ref().map_or(&[][..], |pairing| &pairing.overall);
    let Some(first) = overall.first() else { return String::new() };
    let several_cases = overall.iter().any(|o| o.case != first.case);
    let mut rows = vec![header(first)];
    let mut case = None;
    for entry in overall.iter().take(LINES) {
        if several_cases && case != Some(&entry.case) {
            let mut heading = [const { String::new() }; 5];
            heading[0] = format!("— {}", entry.case);
            rows.push(heading);
            case = Some(&entry.case);
        }
        rows.push(row(entry));
    }
    let mut text = switchback_io::output::columns(&rows);
    if overall.len() > LINES {
        text.push_str(&format!("… and {} more in results.json\n", overall.len() - LINES));
    }
    text.push_str(LEGEND);
    text
}

const LEGEND: &str = "\
Geometric means of ratios over all parameters, each over the first method (border) of the sweep that has it; intervals are 95 %.
Both sides of a ratio see the same noise; `independent`: what as many replicates of each alone would leave.
";

fn header(first: &Overall) -> [String; 5] {
    [
        format!("on the same noise, N = {}", first.samples),
        "variance ratio".to_owned(),
        "independent".to_owned(),
        "with control variates".to_owned(),
        "squared error".to_owned(),
    ]
}

/// A comparison as cells of a table.
pub(crate) fn row(overall: &Overall) -> [String; 5] {
    let more = if overall.over.len() > 1 { ", …" } else { "" };
    let over = overall.over.first().map_or("", String::as_str);
    let ratio = &overall.variance_ratio;
    [
        format!("{} over {over}{more}", overall.subject),
        format!("{} {}", digits(ratio.value(), ratio.mcse()), interval(ratio, ratio.interval(quantile()))),
        interval(ratio, ratio.unpaired_interval(quantile())),
        overall.variance_ratio_controlled.map_or_else(
            || "–".to_owned(),
            |r| format!("{} {}", digits(r.value(), r.mcse()), interval(&r, r.interval(quantile()))),
        ),
        digits(overall.mse_ratio.value(), overall.mse_ratio.mcse()),
    ]
}

fn interval(ratio: &Paired, (low, high): (f64, f64)) -> String {
    format!("[{}, {}]", digits(low, ratio.mcse()), digits(high, ratio.mcse()))
}

/// As many digits as the error leaves, two of it, six decimals at most.
fn digits(x: f64, error: f64) -> String {
    let decimals = if error > 0.0 { (1.0 - error.log10().floor()).clamp(0.0, 6.0) as usize } else { 6 };
    format!("{x:.decimals$}")
}

/// Half the width of a 95 % interval in standard errors.
fn quantile() -> f64 {
    StudentsT::new(0.0, 1.0, FREEDOM).map_or(f64::INFINITY, |t| t.inverse_cdf(0.975))
}
