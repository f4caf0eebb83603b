//! The table at the end of a run.

use super::paired;
use super::row::{Row, rows};
use std::collections::BTreeMap;
use switchback_study::results::{Fitted, Group, Results};

/// The table that ends a run: slopes with intervals, coverage, efficiency and verdict, then what was expected, then failures.
///
/// A row gives the median over its curves (border shapes, m, noise levels; all parameter groups where a row each
/// would not fit a screen). Text only, ends with a newline.
pub fn table(results: &Results) -> String {
    let rows = rows(results);
    let several_cases = rows.iter().any(|r| r.case != rows[0].case);
    let mut lines = vec![header()];
    let mut case = None;
    for row in &rows {
        if several_cases && case != Some(row.case) {
            lines.push(vec![format!("— {}", row.case)]);
            case = Some(row.case);
        }
        lines.push(cells(row));
    }
    let mut text = results.partial.map_or_else(String::new, |partial| format!("{partial}\n"));
    text.push_str(&align(&lines));
    text.push_str(LEGEND);
    text.push_str(&slopes(results));
    text.push_str(&paired::lines(results));
    text.push_str(&expectations(results));
    text.push_str(&precision(results));
    text.push_str(&failures(results));
    text
}

const LEGEND: &str = "\
A row: medians over its border shapes, m and noise levels; intervals are 95 %; coverage and ratios at the largest N.
sd/theory: empirical sd over that of theory. var/CRB: variance over the Cramér–Rao bound. A bias that stays: the largest.
";

/// Over which N slopes are fitted.
fn slopes(results: &Results) -> String {
    match &results.slope_samples[..] {
        [first, .., last] => {
            format!("Slopes are fitted over N = {first} to {last}, that of the bias where it is resolved.\n")
        }
        _ => String::new(),
    }
}

/// The names of the columns.
pub(crate) fn header() -> Vec<String> {
    ["method", "of", "sd slope", "bias slope", "coverage", "sd/theory", "var/CRB", "verdict"]
        .map(str::to_owned)
        .to_vec()
}

/// A row as cells of the table.
pub(crate) fn cells(row: &Row<'_>) -> Vec<String> {
    vec![
        row.method.to_string(),
        group(row.group).to_owned(),
        slope(row.slope(|s| s.sd_slope), 3),
        bias(row),
        row.median(|s| s.coverage.map(|c| c.value())).map_or_else(none, |c| format!("{:.1} %", 100.0 * c)),
        row.median(|s| s.sd_over_theory.map(|r| r.value())).map_or_else(none, |r| format!("{r:.3}")),
        row.median(|s| s.variance_over_bound.map(|r| r.value())).map_or_else(none, ratio),
        row.verdict(),
    ]
}

/// The bias falls with a slope, or it stays.
fn bias(row: &Row<'_>) -> String {
    match row.plateau() {
        Some(plateau) => format!("none: stays at {plateau:.1e}"),
        None => slope(row.slope(|s| s.bias_slope), 2),
    }
}

fn group(group: Option<Group>) -> &'static str {
    match group {
        Some(Group::A) => "a",
        Some(Group::B) => "b",
        Some(Group::Descending) => "descending",
        Some(Group::Ascending) => "ascending",
        None => "all",
    }
}

fn slope(fitted: Option<Fitted>, decimals: usize) -> String {
    let digits = |x: f64| {
        let text = format!("{x:.decimals$}");
        // No minus before what rounds to zero.
        if text.trim_matches(['-', '0', '.']).is_empty() { text.replace('-', "") } else { text }
    };
    fitted.map_or_else(none, |f| format!("{} [{}, {}]", digits(f.estimate), digits(f.ci.0), digits(f.ci.1)))
}

fn ratio(r: f64) -> String {
    if r < 100.0 { format!("{r:.2}") } else { format!("{r:.0}") }
}

fn none() -> String {
    "–".to_owned()
}

/// Columns as wide as their widest entry, two blanks apart; a line of one entry stands alone.
fn align(lines: &[Vec<String>]) -> String {
    let columns = lines.first().map_or(0, Vec::len);
    let width = |c: usize| {
        let entries = lines.iter().filter(|l| l.len() == columns).map(|l| l[c].chars().count());
        entries.max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let padded: Vec<String> = line.iter().zip(&widths).map(|(entry, &w)| format!("{entry:w$}")).collect();
        let line = if line.len() == columns { padded.join("  ") } else { line.join("  ") };
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// One line an expectation, the broken ones last so that they are read.
fn expectations(results: &Results) -> String {
    let reported = |held: bool| {
        results.expectations.iter().filter(move |e| e.held == held).map(move |e| {
            format!("{} {}: {}\n", if held { "as expected: " } else { "NOT expected:" }, e.what, e.detail)
        })
    };
    reported(true).chain(reported(false)).collect()
}

/// How many replicates the cells took to be as precise as asked, and how many are not.
fn precision(results: &Results) -> String {
    if results.cells.iter().all(|c| c.precise.is_none()) {
        return String::new();
    }
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    results.cells.iter().for_each(|c| *counts.entry(c.replicates).or_default() += 1);
    let taken: Vec<String> = counts.iter().map(|(r, cells)| format!("{r} in {cells}")).collect();
    let short: Vec<_> = results.cells.iter().filter(|c| c.precise == Some(false)).collect();
    let reached = match short.first() {
        None => "every cell is as precise as asked".to_owned(),
        Some(first) => format!(
            "{} of {} cells are not as precise as asked (the first: {}, N = {}); raise max_replicates",
            short.len(),
            results.cells.len(),
            first.series,
            first.samples
        ),
    };
    format!("Replicates: {} cells; {reached}.\n", taken.join(", "))
}

fn failures(results: &Results) -> String {
    let failed: Vec<_> = results.cells.iter().filter(|c| c.failures.count > 0).collect();
    let mut methods: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for cell in &results.cells {
        let (count, of) = methods.entry(cell.series.method.name()).or_default();
        *count += cell.failures.count;
        *of += cell.replicates;
    }
    // Beside methods of others all are listed, those that never failed, too.
    let has_foreign = results.cells.iter().any(|c| c.series.method.is_foreign());
    let methods = methods.iter().filter(|(_, (count, _))| *count > 0 || has_foreign);
    let methods: Vec<String> = methods.map(|(name, (count, of))| format!("{name} {count} of {of}")).collect();
    let Some(worst) = failed.iter().max_by_key(|c| c.failures.count) else {
        return if has_foreign {
            format!("Replicates without an estimate: {}.\n", methods.join(", "))
        } else {
            String::new()
        };
    };
    let number = results.cells.iter().position(|cell| cell == *worst).unwrap_or_default();
    let example = worst.failures.replicates.first().map_or_else(String::new, |replicate| {
        format!(" Look into one: switchback replay RESULTS {number}:{replicate}")
    });
    format!(
        "Replicates without an estimate: {}; in {} of {} cells, at most {} of {} ({}, N = {}): {}.{example}\n",
        methods.join(", "),
        failed.len(),
        results.cells.len(),
        worst.failures.count,
        worst.replicates,
        worst.series,
        worst.samples,
        worst.failures.reason.as_deref().unwrap_or("no reason given"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_study::results::synthetic;

    #[test]
    fn the_table_fits_a_screen_and_says_what_came_out() {
        let text = table(&synthetic::results());
        assert!(text.lines().take(12).all(|l| l.chars().count() <= 120), "{text}");
        assert!(text.lines().count() <= 40, "{text}");
        insta::assert_snapshot!(text);
    }
}
