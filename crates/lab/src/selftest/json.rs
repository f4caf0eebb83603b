//! What the checks found, as JSON. Keys stand in the order of the alphabet.

use super::{FALSE_ALARM, Figure, Finding};
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use switchback_io::output::{stamped, stamped_schema};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/selftest/1";

/// Whether the program computes what it should: `selftest --json`.
#[derive(Serialize, JsonSchema)]
struct SelftestFile<'a> {
    /// An entry a check.
    checks: Vec<CheckFile<'a>>,
    /// Probability that a check fails though nothing is wrong.
    #[schemars(range(min = 0, max = 1))]
    false_alarm: f64,
    /// Whether all hold.
    ok: bool,
    /// Seed of what is drawn.
    seed: u64,
}

/// A check.
#[derive(Serialize, JsonSchema)]
struct CheckFile<'a> {
    /// Its name.
    check: &'a str,
    /// What was found and what must be.
    figures: Vec<FigureFile<'a>>,
    /// Whether it holds.
    ok: bool,
    /// Why it could not be run.
    refused: Option<&'a str>,
    /// What is wrong where it fails.
    wrong: Option<&'a str>,
}

/// A number or a word that a check found.
#[derive(Serialize, JsonSchema)]
struct FigureFile<'a> {
    /// What must be found: a value with the range that chance leaves it, a limit, or a word.
    expected: &'a str,
    /// What was found.
    found: &'a str,
    /// Whether that is as it must be.
    ok: bool,
    /// What it is, with its unit.
    what: &'a str,
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<SelftestFile<'_>>(SCHEMA)
}

/// Everything that was found.
pub fn json(findings: &[Finding], seed: u64) -> String {
    let ok = findings.iter().all(Finding::holds);
    let checks = findings.iter().map(CheckFile::of).collect();
    stamped(SCHEMA, &SelftestFile { checks, false_alarm: FALSE_ALARM, ok, seed })
}

impl<'a> CheckFile<'a> {
    fn of(finding: &'a Finding) -> Self {
        let ok = finding.holds();
        Self {
            check: finding.check,
            figures: finding.figures.iter().flatten().map(FigureFile::of).collect(),
            ok,
            refused: finding.figures.as_ref().err().map(String::as_str),
            wrong: (!ok).then_some(finding.wrong),
        }
    }
}

impl<'a> FigureFile<'a> {
    fn of(figure: &'a Figure) -> Self {
        let Figure { what, found, expected, .. } = figure;
        Self { expected, found, ok: figure.holds(), what }
    }
}

#[cfg(test)]
mod tests {
    use super::super::words::tests::findings;
    use super::*;

    #[test]
    fn json_holds_every_figure() {
        let page: serde_json::Value = serde_json::from_str(&json(&findings(), 3)).expect("JSON");
        assert_eq!(page["schema"], "switchback/selftest/1");
        assert_eq!((&page["ok"], &page["checks"][0]["ok"]), (&false.into(), &true.into()));
        assert_eq!(page["checks"][1]["figures"].as_array().map(Vec::len), Some(7));
        assert_eq!(page["checks"][2]["refused"], "no estimate");
    }
}
