//! What the checks found, as a table with the reasons of failures.

use super::{FALSE_ALARM, Figure, Finding};
use std::fmt::Write as _;
use switchback_io::output::columns;

/// Figures that are listed of a check that failed; the rest is counted.
const LISTED: usize = 5;

/// A row a check with the figure nearest to its limit, and below what is wrong.
pub fn table(findings: &[Finding], seed: u64) -> String {
    let head = ["check", "figures", "nearest to its limit", "found", "expected", ""].map(str::to_owned);
    let rows: Vec<[String; 6]> = std::iter::once(head).chain(findings.iter().map(row)).collect();
    let mut text = columns(&rows);
    let limits = "Ranges leave chance a probability of";
    let _ = writeln!(
        text,
        "{limits} {FALSE_ALARM:e} a check that it fails though nothing is wrong. Seed {seed}."
    );
    for finding in findings.iter().filter(|finding| !finding.holds()) {
        let _ = writeln!(text, "\n{} FAILED: {}.", finding.check, finding.wrong);
        if let Err(reason) = &finding.figures {
            let _ = writeln!(text, "  it could not be run: {reason}");
        }
        for Figure { what, found, expected, .. } in finding.failed().take(LISTED) {
            let _ = writeln!(text, "  {what}: found {found}, expected {expected}");
        }
        let more = finding.failed().count().saturating_sub(LISTED);
        if more > 0 {
            let _ = writeln!(text, "  and {more} more; --json has them all");
        }
    }
    text
}

fn row(finding: &Finding) -> [String; 6] {
    let count = finding.figures.as_ref().map_or(0, Vec::len).to_string();
    let verdict = if finding.holds() { "ok" } else { "FAILED" }.to_owned();
    let [what, found, expected] = finding.nearest().map_or_else(
        || ["none", "–", "–"].map(str::to_owned),
        |figure| [figure.what.clone(), figure.found.clone(), figure.expected.clone()],
    );
    [finding.check.to_owned(), count, what, found, expected, verdict]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::selftest) fn findings() -> Vec<Finding> {
        let wrong = "the noise of studies is wrong";
        let many = (0..7).map(|k| Figure::at_most(format!("figure {k}"), 2.0, 1.0)).collect();
        vec![
            Finding { check: "engines", wrong: "-", figures: Ok(vec![Figure::at_most("apart", 1e-9, 1e-6)]) },
            Finding { check: "noise", wrong, figures: Ok(many) },
            Finding {
                check: "coverage",
                wrong: "intervals are wrong",
                figures: Err("no estimate".to_owned()),
            },
        ]
    }

    #[test]
    fn failures_say_what_is_wrong_in_plain_words() {
        let reported = table(&findings(), 3);
        for words in [
            "engines         1                 apart  1.000e-9  at most 1.000e-6      ok",
            "noise FAILED: the noise of studies is wrong.",
            "figure 0: found 2, expected at most 1",
            "and 2 more",
            "coverage FAILED: intervals are wrong.\n  it could not be run: no estimate",
            "Seed 3.",
        ] {
            assert!(reported.contains(words), "{words} is not in\n{reported}");
        }
        assert!(!reported.contains("engines FAILED"));
    }
}
