//! Comparing learners on the same folds.

use super::calibration::{mixed, shares};
use super::combined::{Models, out_of_fold};
use super::scores::{Scores, scores};
use super::settings::LearningSettings;
use super::table::Table;
use crate::examination::uniform;
use serde::Serialize;
use std::fmt::Write;

/// A learner's scores on rows whose base and law it did not learn.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Its name.
    pub name: String,
    /// Share of the rows that it learnt from.
    pub share: f64,
    /// Its scores.
    pub scores: Scores,
}

/// All learners, and how they grow with the rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Learners at each share of the rows.
    pub all: Vec<Compared>,
}

/// Shares of the rows in a learning curve.
const CURVE: [f64; 3] = [0.25, 0.5, 1.0];
const CURVE_SEED: u64 = 1;

/// Scores trees, network, ranker and their mean out of fold, at a quarter, a half and all of the rows.
///
/// The shares of the mean are fitted to the rows that score it: three numbers on thousands of rows.
pub fn compare(table: &Table, settings: &LearningSettings) -> Comparison {
    let mut all = Vec::new();
    for share in CURVE {
        let rows: Vec<usize> =
            (0..table.rows()).filter(|row| uniform(CURVE_SEED, *row as u64) < share).collect();
        let (judged, found) = out_of_fold(&table.of_rows(&rows), settings);
        let judged = table.of_rows(&judged.iter().map(|row| rows[*row]).collect::<Vec<usize>>());
        let mut add = |name: &str, p: &[Vec<f64>]| {
            let scores = scores(p, &judged.labels, &judged.weights);
            all.push(Compared { name: name.to_owned(), share, scores });
        };
        for (name, p) in Models::NAMES.iter().zip(&found) {
            add(name, p);
        }
        let weights = shares(&found, &judged.labels, &judged.weights);
        add("together", &mixed(&found, &weights));
    }
    Comparison { all }
}

/// A line of the JSON.
#[derive(Serialize)]
struct Line<'a> {
    name: &'a str,
    share: f64,
    rows: usize,
    log_score: f64,
    brier: f64,
    calibration_error: f64,
    calibration_error_if_perfect: f64,
    top1: f64,
    top5: f64,
}

impl Comparison {
    /// A table in Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::from(
            "| learner | rows | log score | Brier | calibration error (perfect) | first | first five |\n|---|--:|--:|--:|--:|--:|--:|\n",
        );
        for Compared { name, scores: s, .. } in &self.all {
            let _ = writeln!(
                text,
                "| {name} | {} | {:.3} | {:.3} | {:.3} ({:.3}) | {:.1} % | {:.1} % |",
                s.rows,
                s.log,
                s.brier,
                s.calibration,
                s.perfect,
                100.0 * s.top1,
                100.0 * s.top5
            );
        }
        text
    }

    /// The same as JSON.
    pub fn json(&self) -> String {
        let line = |c: &Compared| {
            let s = c.scores;
            serde_json::to_value(Line {
                name: &c.name,
                share: c.share,
                rows: s.rows,
                log_score: s.log,
                brier: s.brier,
                calibration_error: s.calibration,
                calibration_error_if_perfect: s.perfect,
                top1: s.top1,
                top5: s.top5,
            })
            .expect("numbers and names are JSON")
        };
        let lines: Vec<_> = self.all.iter().map(line).collect();
        format!("{:#}\n", serde_json::json!({ "learners": lines }))
    }
}
