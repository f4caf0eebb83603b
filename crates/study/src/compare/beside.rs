//! What two result tables hold beside their measures: of what study, of what runs, and what was made of the measures.

use super::tree::changes;
use crate::results::{Cell, Results};
use serde_json::{Value, to_value};

/// Differences beside the measures.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Beside {
    /// Those that chance does not explain.
    pub(super) known: Vec<String>,
    /// Those that two runs of one study may have.
    pub(super) runs: Vec<String>,
}

/// Keys of a scenario that say how much is run and what is asked of it, not what is studied.
const OF_THE_RUN: [&str; 7] =
    ["seed", "replicates", "max_replicates", "precision", "engine", "question", "expect"];

/// What a condensed table leaves out.
const CONDENSED: [&str; 2] = ["comparisons", "digits"];

/// Keys of texts with figures in them, the last digit of which may be rounded either way.
const TEXTS: [&str; 2] = ["reason", "detail"];

/// Keys that are judged: chance may change them, and does so seldom.
const JUDGED: [&str; 3] = ["verdict", "held", "precise"];

/// Compares all but the measures; `is_same` says whether these are the same to rounding, so that nothing made of them may differ.
/// `chance` is the largest difference of two shares of failures, in standard errors, that chance explains.
pub(super) fn beside(
    baseline: &Results,
    new: &Results,
    (is_same, rounding, chance): (bool, f64, f64),
) -> Beside {
    let mut found = Beside::default();
    let is_condensed = baseline.digits.or(new.digits).is_some();
    for change in changes(&without_measures(baseline), &without_measures(new), rounding) {
        if is_condensed && change.path.iter().any(|key| CONDENSED.contains(&key.as_str())) {
            continue;
        }
        let is_real = match change.path[0].as_str() {
            "seed" | "name" | "question" | "engine" => false,
            "scenario" => change.path.get(1).is_none_or(|key| !OF_THE_RUN.contains(&key.as_str())),
            made @ ("summaries" | "expectations" | "paired") => {
                // Whether a slope is resolved is chance; whether there is a summary is not.
                let is_entry = change.path.len() <= if made == "paired" { 3 } else { 2 };
                let is_asked = made != "expectations" || asks(baseline) == asks(new);
                let is_text = TEXTS.contains(&change.key());
                !is_text && (is_same || JUDGED.contains(&change.key()) || (is_entry && is_asked))
            }
            _ => true,
        };
        if is_real { &mut found.known } else { &mut found.runs }.push(change.line());
    }
    of_cells(baseline, new, (is_same, chance), &mut found);
    found
}

fn asks(results: &Results) -> Option<&Value> {
    results.scenario.get("expect")
}

/// A table without its measures, and without the words that name version and command, which are shown elsewhere.
fn without_measures(results: &Results) -> Value {
    let bare = Results { cells: Vec::new(), ..results.clone() };
    let mut value = to_value(bare).expect("a result table is JSON");
    if let Some(fields) = value.as_object_mut() {
        fields.retain(|key, _| !["version", "command", "cells"].contains(&key.as_str()));
    }
    value
}

/// What the cells that both tables hold say of their replicates.
fn of_cells(baseline: &Results, new: &Results, (is_same, chance): (bool, f64), found: &mut Beside) {
    let asked = |results: &Results| {
        ["replicates", "max_replicates", "precision"].map(|key| results.scenario.get(key).cloned())
    };
    let is_asked_the_same = asked(baseline) == asked(new);
    for (k, cell) in baseline.cells.iter().enumerate() {
        let name = || format!("{}, N = {}", cell.series, cell.samples);
        let is_it = |other: &&Cell| other.samples == cell.samples && other.series == cell.series;
        let (twice, of_new) =
            (baseline.cells[..k].iter().any(|other| is_it(&other)), new.cells.iter().filter(is_it).count());
        if twice || of_new > 1 {
            found.known.push(format!("{}: is there more than once", name()));
        }
        let Some(other) = new.cells.iter().find(is_it) else { continue };
        for change in changes(&replicates(cell), &replicates(other), 0.0) {
            let is_real = is_same
                || match change.path[0].as_str() {
                    "replicates" => is_asked_the_same && baseline.scenario.get("precision").is_none(),
                    "failures" => change.key() == "count" && apart(cell, other) > chance,
                    "precise" => true,
                    _ => false,
                };
            let line = format!("{}: {}", name(), change.line());
            if is_real { &mut found.known } else { &mut found.runs }.push(line);
        }
    }
}

/// A cell without its parameters.
fn replicates(cell: &Cell) -> Value {
    to_value(Cell { parameters: Vec::new(), ..cell.clone() }).expect("a cell is JSON")
}

/// How far apart the shares of failures of two cells are, in standard errors; infinite where one has no replicate.
fn apart(one: &Cell, other: &Cell) -> f64 {
    let [(k, n), (l, m)] = [one, other].map(|cell| (cell.failures.count as f64, cell.replicates as f64));
    let share = (k + l) / (n + m);
    let error = (share * (1.0 - share) * (1.0 / n + 1.0 / m)).sqrt();
    if n == 0.0 || m == 0.0 || (error == 0.0 && k != l) {
        f64::INFINITY
    } else {
        ((k / n - l / m) / error).abs()
    }
}

#[cfg(test)]
mod tests {
    use crate::compare::compare;
    use crate::results::{Partial, Results, Verdict, synthetic};
    use serde_json::json;

    fn base() -> Results {
        let mut results = synthetic::results();
        results.scenario = json!({ "seed": 1, "replicates": 500, "system": { "a": [-1.2, 0.45] }, "sweep": { "noise": [0.02] } });
        results
    }

    /// What differs besides measures, after a change.
    fn known(change: impl FnOnce(&mut Results)) -> Vec<String> {
        let mut new = base();
        change(&mut new);
        let (there, back) = (compare(&base(), &new), compare(&new, &base()));
        assert_eq!(there.agrees(), back.agrees(), "{:?}", there.known);
        if !there.agrees() {
            assert!(!there.identical() && !back.identical());
        }
        there.known.into_iter().chain(there.only_baseline).chain(there.only_new).collect()
    }

    type Change = fn(&mut Results);

    #[test]
    fn nothing_that_chance_does_not_explain_is_passed_over() {
        assert_eq!(known(|_| ()), Vec::<String>::new());
        let changes: [(&str, Change); 14] = [
            ("failures: count, 0 → 499", |r| r.cells[0].failures.count = 499),
            ("replicates, 500 → 0", |r| r.cells[0].replicates = 0),
            ("partial", |r| r.partial = Some(Partial { replicates: 10, of: 80 })),
            ("scenario: system: a", |r| r.scenario["system"]["a"] = json!([-1.1, 0.4])),
            ("scenario: sweep: noise", |r| r.scenario["sweep"]["noise"] = json!([0.02, 0.1])),
            ("expectations: number of entries, 2 → 0", |r| r.expectations.clear()),
            ("expectations: joint is consistent: held, true → false", |r| r.expectations[0].held = false),
            ("summaries: number of entries", |r| r.summaries.clear()),
            ("verdict, \"consistent\" → \"inconsistent\"", |r| {
                r.summaries[0].verdict = Verdict::Inconsistent;
            }),
            ("is there more than once", |r| r.cells.push(r.cells[3].clone())),
            ("paired, ", |r| r.paired = None),
            ("labels: input", |r| r.labels.input = "deflection [m]".to_owned()),
            ("curves", |r| r.curves[0].points[7].descending += 1e-3),
            ("intervals", |r| r.cells[1].intervals[0].below[2] += 1),
        ];
        for (words, change) in changes {
            let found = known(change);
            assert!(found.iter().any(|line| line.contains(words)), "{words}: {found:?}");
        }
    }

    #[test]
    fn another_seed_is_reported_and_agrees_as_far_as_the_measures_do() {
        let mut new = base();
        (new.seed, new.scenario["seed"], new.question) = (2, json!(2), "another?".to_owned());
        let comparison = compare(&base(), &new);
        assert!(comparison.agrees() && !comparison.identical());
        assert_eq!(comparison.runs.len(), 3, "{:?}", comparison.runs);
        // What was made of other measures may differ, what was judged may not.
        let sd = &mut new.cells[0].parameters[0].sd;
        *sd = sd.and_then(|m| crate::results::Measured::new(m.value() + 0.1 * m.mcse(), m.mcse()));
        (new.summaries[0].plateau, new.cells[0].failures.count) = (None, 2);
        let comparison = compare(&base(), &new);
        assert!(comparison.agrees(), "{:?}", comparison.known);
        assert!(comparison.runs.iter().any(|line| line.contains("failures: count, 0 → 2")));
        new.cells[0].failures.count = 200;
        assert!(!compare(&base(), &new).agrees());
    }
}
