//! What came out at each version: one JSON object a line, in a small file that a repository keeps.

use super::judge::{Comparison, Judged, Measure, Verdict};
use super::text::place;
use super::versions::Version;
use miette::Diagnostic;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::str::FromStr;
use switchback_io::input::{FileError, TextKind, read_text};
use switchback_io::output::schema as schema_of;
use thiserror::Error;

/// Name and version of the layout of a line.
const SCHEMA: &str = "switchback/bench-history/1";

/// All that came out so far, the newest last.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    entries: Vec<Entry>,
}

/// What came out once: a line of a history, see `bench --history`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// What the new version is called in the history: a commit, a tag, a date.
    pub label: Label,
    /// The scenario's name.
    pub scenario: String,
    /// The method that is compared with.
    pub baseline: String,
    /// What it says its version is.
    pub baseline_version: String,
    /// The method that is judged.
    pub new: String,
    /// What it says its version is.
    pub new_version: String,
    /// The seed of every random stream.
    pub seed: u64,
    /// Replicates of each cell.
    pub replicates: u32,
    /// The verdict on all differences.
    pub verdict: Verdict,
    /// The difference of bias that comes nearest to its limit, in standard deviations of the baseline.
    pub bias: Largest,
    /// The same of the logarithm of the ratio of standard deviations.
    pub sd: Largest,
    /// The same of failures, as a share of the replicates.
    pub failures: Largest,
}

/// The difference that comes nearest to its limit; null where a figure is no number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Largest {
    /// The difference.
    pub value: Option<f64>,
    /// Its Monte-Carlo standard error.
    pub se: Option<f64>,
    /// Beyond it a difference is an alarm, or an improvement.
    pub limit: Option<f64>,
    /// Of which parameter, in which cell.
    pub at: String,
    /// The verdict on all differences of this measure.
    pub verdict: Verdict,
}

/// What an entry is called: 1 to 60 characters on one line.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
pub struct Label(String);

/// Longest label, characters.
const LONGEST: usize = 60;

impl FromStr for Label {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let is_fit = !text.trim().is_empty() && text.chars().count() <= LONGEST;
        if is_fit && !text.chars().any(char::is_control) {
            Ok(Self(text.to_owned()))
        } else {
            Err("write 1 to 60 characters on one line, as a commit or a date")
        }
    }
}

impl TryFrom<String> for Label {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse()
    }
}

impl From<Label> for String {
    fn from(label: Label) -> Self {
        label.0
    }
}

impl Label {
    /// As it was given.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// Why a file is no history.
#[derive(Debug, Error, Diagnostic)]
pub enum HistoryError {
    /// It cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Unreadable(#[from] FileError),
    /// A line is no entry.
    #[error("{path}:{line}: this is no entry of a history: {why}")]
    #[diagnostic(help(
        "give a file that `switchback bench --history` wrote, or the name of a new one; nothing was changed"
    ))]
    NoEntry {
        /// The file.
        path: String,
        /// The line.
        line: usize,
        /// What is wrong with it.
        why: String,
    },
}

/// The JSON Schema of a line.
pub fn schema() -> Schema {
    schema_of::<Entry>(SCHEMA)
}

impl History {
    /// Reads a history; an empty one where there is no file.
    ///
    /// # Errors
    /// [`HistoryError`] if it cannot be read, or a line is no entry.
    pub fn read(path: &Path) -> Result<Self, HistoryError> {
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = read_text(path, TextKind::Results)?;
        let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let entry = |(k, line): (usize, &str)| {
            let refused = |error: serde_json::Error| HistoryError::NoEntry {
                path: path.display().to_string(),
                line: k + 1,
                why: error.to_string(),
            };
            serde_json::from_str(line).map_err(refused)
        };
        Ok(Self { entries: lines.map(entry).collect::<Result<_, _>>()? })
    }

    /// Adds an entry. One of the same label, scenario and methods gives it its place: a run that is repeated is no other version.
    pub fn add(&mut self, entry: Entry) {
        match self.entries.iter_mut().find(|other| other.label == entry.label && other.is_of(&entry)) {
            Some(before) => *before = entry,
            None => self.entries.push(entry),
        }
    }

    /// Those of the same scenario and methods, the newest last.
    pub fn of<'h>(&'h self, entry: &Entry) -> Vec<&'h Entry> {
        self.entries.iter().filter(|other| other.is_of(entry)).collect()
    }

    /// The file, a line an entry.
    pub fn text(&self) -> String {
        let line = |entry| serde_json::to_string(entry).expect("numbers and names are JSON") + "\n";
        self.entries.iter().map(line).collect()
    }
}

impl Entry {
    /// What came out of a comparison.
    pub fn of(
        label: Label,
        comparison: &Comparison,
        (scenario, seed): (&str, u64),
        [baseline, new]: &[Version; 2],
    ) -> Self {
        let largest = |measure| Largest::of(comparison, measure);
        Self {
            label,
            scenario: scenario.to_owned(),
            baseline: baseline.name.clone(),
            baseline_version: baseline.version.clone(),
            new: new.name.clone(),
            new_version: new.version.clone(),
            seed,
            replicates: comparison.replicates,
            verdict: comparison.verdict(),
            bias: largest(Measure::Bias),
            sd: largest(Measure::Sd),
            failures: largest(Measure::Failures),
        }
    }

    fn is_of(&self, other: &Self) -> bool {
        (&self.scenario, &self.baseline, &self.new) == (&other.scenario, &other.baseline, &other.new)
    }

    /// The difference of a measure that comes nearest to its limit.
    pub fn largest(&self, measure: Measure) -> &Largest {
        match measure {
            Measure::Bias => &self.bias,
            Measure::Sd => &self.sd,
            Measure::Failures => &self.failures,
        }
    }
}

impl Largest {
    fn of(comparison: &Comparison, measure: Measure) -> Self {
        let verdict = comparison.verdict_on(measure);
        let Some((cell, parameter, Judged { value, se, limit, .. })) = comparison.largest(measure) else {
            return Self { value: None, se: None, limit: None, at: String::new(), verdict };
        };
        let at = place(cell, parameter);
        Self { value: short(value), se: short(se), limit: short(limit), at, verdict }
    }
}

/// Four significant digits: the file stays small.
fn short(x: f64) -> Option<f64> {
    x.is_finite().then(|| format!("{x:.3e}").parse().unwrap_or(x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use tempfile::tempdir;

    fn entry(label: &str, value: f64) -> Entry {
        let largest = Largest {
            value: short(value),
            se: Some(0.01),
            limit: Some(0.05),
            at: "a1, N = 300".to_owned(),
            verdict: Verdict::Equivalent,
        };
        Entry {
            label: label.parse().expect("a label"),
            scenario: "study".to_owned(),
            baseline: "old".to_owned(),
            baseline_version: "1".to_owned(),
            new: "new".to_owned(),
            new_version: "2".to_owned(),
            seed: 1,
            replicates: 400,
            verdict: Verdict::Equivalent,
            bias: largest.clone(),
            sd: largest.clone(),
            failures: Largest { value: None, ..largest },
        }
    }

    #[test]
    fn entries_read_back_and_a_repeated_run_takes_its_own_place() {
        let folder = tempdir().expect("a folder");
        let file = folder.path().join("history.jsonl");
        let mut history = History::read(&file).expect("none yet");
        history.add(entry("c1", 0.123_456_7));
        history.add(entry("c2", 0.1));
        fs::write(&file, history.text()).expect("it can be written");
        let mut back = History::read(&file).expect("a history");
        assert_eq!(back, history);
        back.add(entry("c1", 0.5));
        back.add(Entry { new: "other".to_owned(), ..entry("c1", 0.2) });
        let values: Vec<Option<f64>> = back.of(&entry("x", 0.0)).iter().map(|e| e.bias.value).collect();
        assert_eq!(values, [Some(0.5), Some(0.1)]);
        assert_eq!(back.text().lines().count(), 3);
    }

    #[test]
    fn what_is_no_history_is_refused_with_its_line() {
        let folder = tempdir().expect("a folder");
        let file = folder.path().join("history.jsonl");
        let good = History { entries: vec![entry("c1", 0.1)] }.text();
        for (text, line) in [
            ("t,v,y\n".to_owned(), ":1:"),
            (format!("{good}\n{{}}\n"), ":3:"),
            (good.replace("c1", ""), ":1:"),
        ] {
            fs::write(&file, &text).expect("it can be written");
            let error = History::read(&file).expect_err("no history").to_string();
            assert!(error.contains(line), "{error}");
        }
        for label in ["", " ", "a\nb", &"x".repeat(61)] {
            assert!(label.parse::<Label>().is_err(), "{label:?}");
        }
    }
}
