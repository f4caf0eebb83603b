//! Learning all models, and a posterior of them.

use super::binned::Binned;
use super::boosting::{Target, boost};
use super::calibration::{mixed, shares, temperature};
use super::folds::folds;
use super::network::train_network;
use super::novelty::learn_novelty;
use super::ranker::train_ranker;
use super::settings::LearningSettings;
use super::table::Table;
use rayon::prelude::*;
use switchback_diagnose::posterior::{Network, Posterior, Ranker, Shares, Trees, softmax};

/// The models of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Models {
    /// Boosted trees.
    pub trees: Trees,
    /// The network.
    pub network: Network,
    /// The ranker, where classes have columns of their own.
    pub ranker: Option<Ranker>,
}

impl Models {
    /// Names of the models whose probabilities [`Self::probabilities`] gives.
    pub const NAMES: [&'static str; 3] = ["trees", "network", "ranker"];

    /// Learns all three.
    pub fn learn(table: &Table, settings: &LearningSettings) -> Self {
        let target = Target::Classes(table.labels.clone(), table.classes.len());
        Self {
            trees: boost(&Binned::new(&table.values), &target, &table.weights, &settings.trees),
            network: train_network(table, &settings.network),
            ranker: train_ranker(table, settings),
        }
    }

    /// Probabilities of rows by each model that there is.
    pub fn probabilities(&self, table: &Table) -> Vec<Vec<Vec<f64>>> {
        let rows = |of: &(dyn Fn(&[f64]) -> Vec<f64> + Sync)| -> Vec<Vec<f64>> {
            (0..table.rows()).into_par_iter().map(|row| of(&table.row(row))).collect()
        };
        let by_trees = |row: &[f64]| softmax(&self.trees.scores(row));
        let mut all = vec![rows(&by_trees), rows(&|row| softmax(&self.network.scores(row)))];
        if let Some(ranker) = &self.ranker {
            all.push(rows(&|row| ranker.probabilities(row, &by_trees(row))));
        }
        all
    }
}

/// Probabilities of every row by models that learnt neither its base nor its law, and the rows in the same order.
pub(super) fn out_of_fold(table: &Table, settings: &LearningSettings) -> (Vec<usize>, Vec<Vec<Vec<f64>>>) {
    let (mut rows, mut all): (Vec<usize>, Vec<Vec<Vec<f64>>>) = (Vec::new(), Vec::new());
    for fold in folds(table, settings.folds) {
        let models = Models::learn(&table.of_rows(&fold.learnt), settings);
        let found = models.probabilities(&table.of_rows(&fold.judged));
        all.resize(found.len().max(all.len()), Vec::new());
        all.iter_mut().zip(found).for_each(|(all, p)| all.extend(p));
        rows.extend(fold.judged);
    }
    (rows, all)
}

/// The rows of a table that models judged which had learnt neither their base nor their law, and the probabilities of their geometric mean.
pub fn held_out(table: &Table, settings: &LearningSettings) -> (Table, Vec<Vec<f64>>) {
    let (rows, found) = out_of_fold(table, settings);
    let judged = table.of_rows(&rows);
    let shares = shares(&found, &judged.labels, &judged.weights);
    let p = mixed(&found, &shares);
    (judged, p)
}

/// Learns a posterior: the models on all rows, their shares and the temperatures of each family on rows that were held out.
pub fn fit(table: &Table, settings: &LearningSettings, provenance: &str) -> Posterior {
    let (rows, held_out) = out_of_fold(table, settings);
    let judged = table.of_rows(&rows);
    let found = shares(&held_out, &judged.labels, &judged.weights);
    let mixed = mixed(&held_out, &found);
    let models = Models::learn(table, settings);
    let mut families: Vec<&String> = judged.groups.iter().map(|group| &group.family).collect();
    families.sort();
    families.dedup();
    let of_family = |family: &&String| {
        let is = |row: &usize| judged.groups[*row].family == **family;
        let rows: Vec<usize> = (0..judged.rows()).filter(is).collect();
        let pick = |row: &usize| (mixed[*row].clone(), judged.labels[*row], judged.weights[*row]);
        let (mut p, mut labels, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for (one, label, weight) in rows.iter().map(pick) {
            p.push(one);
            labels.push(label);
            weights.push(weight);
        }
        ((*family).clone(), temperature(&p, &labels, &weights) as f32)
    };
    let share = |k: usize| found.get(k).map_or(0.0, |s| *s as f32);
    Posterior {
        provenance: provenance.to_owned(),
        columns: table.columns.clone(),
        classes: table.classes.clone(),
        temperatures: families.iter().map(of_family).collect(),
        novelty: learn_novelty(table, settings.directions),
        shares: Shares { trees: share(0), network: share(1), ranker: share(2) },
        trees: models.trees,
        network: Some(models.network),
        ranker: models.ranker,
    }
}
