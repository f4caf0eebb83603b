//! Whether what the scenario promises came out.

use super::intervals;
use crate::MethodName;
use crate::results::{Cell, Expectation, Fitted, Summary, Verdict};
use crate::scenario::{Check, Scenario};
use statrs::distribution::{ContinuousCDF, StudentsT};
use switchback_identify::Method;

/// Chance that a true promise is found broken, over all the rows it is checked on.
const FALSE_ALARM: f64 = 0.01;

/// A slope this far from that of theory is as good as the same: theory is exact to the second order in the noise only, so that enough
/// replicates distinguish any two slopes.
const SAME_SLOPE: f64 = 0.01;

/// Degrees of freedom behind the errors of summaries (sections of replicates less one).
const FREEDOM: f64 = (super::sections::SECTIONS - 1) as f64;

/// One entry a promise of each case.
pub(super) fn check(scenario: &Scenario, summaries: &[Summary], cells: &[Cell]) -> Vec<Expectation> {
    let mut expectations = Vec::new();
    for case in scenario.cases() {
        let of_case = |method: &MethodName| -> Vec<&Summary> {
            summaries.iter().filter(|s| s.series.case == case.name && s.series.method == *method).collect()
        };
        let prefix = if scenario.cases().len() > 1 { format!("{}: ", case.name) } else { String::new() };
        for method in &case.expect.consistent {
            expectations.push(all_consistent(&prefix, method, &of_case(method)));
        }
        for method in &case.expect.inconsistent {
            expectations.push(found_inconsistent(&prefix, method, &of_case(method)));
        }
        let rows: Vec<&Summary> = case.expect.consistent.iter().flat_map(of_case).collect();
        expectations
            .extend(case.expect.within_error.iter().map(|&check| within_error(&prefix, check, &rows)));
        let cells_of = |case: &str| cells.iter().filter(|c| c.series.case == case).collect::<Vec<_>>();
        let of_case = cells_of(&case.name);
        expectations
            .extend(case.expect.coverage.map(|bounds| intervals::coverage(&prefix, bounds, &of_case)));
        let width = case.expect.width.as_ref();
        expectations.extend(width.map(|w| intervals::width(&prefix, w, &of_case, &cells_of(&w.of))));
    }
    expectations
}

fn all_consistent(prefix: &str, method: &MethodName, rows: &[&Summary]) -> Expectation {
    let other = rows.iter().find(|s| s.verdict != Verdict::Consistent);
    Expectation {
        what: format!("{prefix}{method} is consistent"),
        held: other.is_none() && !rows.is_empty(),
        detail: match other {
            Some(s) => format!("{}, {}: {}: {}", s.series, s.group.label(), s.verdict, s.reason),
            None => format!("in all {} rows", rows.len()),
        },
    }
}

/// A method is inconsistent if one of its parameter groups is, in every curve of the case.
fn found_inconsistent(prefix: &str, method: &MethodName, rows: &[&Summary]) -> Expectation {
    let exposed =
        |s: &Summary| rows.iter().any(|r| r.series == s.series && r.verdict == Verdict::Inconsistent);
    let hidden = rows.iter().find(|s| !exposed(s));
    let shown = rows.iter().find(|s| s.verdict == Verdict::Inconsistent);
    Expectation {
        what: format!("{prefix}{method} is found inconsistent"),
        held: hidden.is_none() && shown.is_some(),
        detail: match (hidden, shown) {
            (Some(s), _) => format!("not in {}: {}: {}", s.series, s.verdict, s.reason),
            (None, Some(s)) => format!("in every curve; {}, {}: {}", s.series, s.group.label(), s.reason),
            (None, None) => "no curve to judge".to_owned(),
        },
    }
}

/// The row farthest from what theory says must be no farther than the margin of the check and what chance explains among so many rows.
fn within_error(prefix: &str, check: Check, rows: &[&Summary]) -> Expectation {
    let distances: Vec<(f64, &Summary)> =
        rows.iter().filter_map(|s| Some((distance(check, s)?, *s))).collect();
    let margin = match check {
        Check::SdSlope | Check::BiasSlope => format!(" beyond {SAME_SLOPE}"),
        Check::SdOverTheory | Check::Coverage | Check::Efficiency => String::new(),
    };
    let limit = StudentsT::new(0.0, 1.0, FREEDOM)
        .map_or(f64::INFINITY, |t| t.inverse_cdf(1.0 - FALSE_ALARM / (2.0 * distances.len().max(1) as f64)));
    let worst = distances.iter().max_by(|x, y| x.0.abs().total_cmp(&y.0.abs()));
    Expectation {
        what: format!("{prefix}{} within Monte-Carlo error of theory", check.name()),
        held: worst.is_some_and(|w| w.0.abs() <= limit),
        detail: match worst {
            Some((z, s)) => format!(
                "largest of {} distances is {z:+.1} standard errors{margin} (limit {limit:.1}): {}, {}",
                distances.len(),
                s.series,
                s.group.label()
            ),
            None => "no row has this figure".to_owned(),
        },
    }
}

/// How many standard errors a row lies from what theory says, for a slope beyond [`SAME_SLOPE`]; `None` where the figure does not exist or
/// does not apply.
fn distance(check: Check, summary: &Summary) -> Option<f64> {
    let slope = |fitted: Option<Fitted>, target: f64| {
        let fitted = fitted?;
        let half_width = 0.5 * (fitted.ci.1 - fitted.ci.0);
        let t = StudentsT::new(0.0, 1.0, FREEDOM).ok()?.inverse_cdf(0.975);
        let apart = fitted.estimate - target;
        let beyond = (apart.abs() - SAME_SLOPE).max(0.0).copysign(apart);
        (half_width > 0.0).then(|| beyond / (half_width / t))
    };
    match check {
        Check::SdSlope => slope(summary.sd_slope, summary.sd_slope_theory.unwrap_or(-0.5)),
        Check::BiasSlope => slope(summary.bias_slope, summary.bias_slope_theory.unwrap_or(-1.0)),
        Check::SdOverTheory => summary.sd_over_theory?.z(1.0),
        Check::Coverage => summary.coverage?.z(0.95),
        Check::Efficiency if summary.series.method == Method::Efficient => {
            summary.variance_over_bound?.z(1.0)
        }
        Check::Efficiency => None,
    }
}
