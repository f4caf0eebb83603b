//! Comparing learners on the same folds.

use super::calibration::{mixed, shares};
use super::combined::{Models, out_of_fold};
use super::scores::{Scores, scores};
use super::settings::LearningSettings;
use super::table::Table;
use crate::examination::uniform;

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

/// Shares of the rows in a learning curve.
const CURVE: [f64; 3] = [0.25, 0.5, 1.0];
const CURVE_SEED: u64 = 1;

/// Scores trees, network, ranker and their mean out of fold, at a quarter, a half and all of the rows.
///
/// The shares of the mean are fitted to the rows that score it: three numbers on thousands of rows.
pub fn compare(table: &Table, settings: &LearningSettings) -> Vec<Compared> {
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
    all
}
