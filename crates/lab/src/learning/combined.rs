//! Learning all models, and a posterior of them.

use super::binned::Binned;
use super::boosting::{Target, boost};
use super::calibration::{cooled, mixed, shares, temperature};
use super::folds::folds;
use super::network::train_network;
use super::novelty::learn_novelty;
use super::ranker::train_ranker;
use super::second_stage::{second_stage, validated};
use super::settings::LearningSettings;
use super::table::{Table, TableError};
use super::thresholds::{fit_thresholds, outcomes};
use rayon::prelude::*;
use switchback_diagnose::posterior::{
    Losses, Network, Outcome, Posterior, Prior, Ranker, Shares, Thresholds, Trees, softmax,
};

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
            all.push(rows(&|row| ranker.probabilities(row)));
        }
        all
    }
}

/// Probabilities of every row by models that learnt neither its base nor its law, and the rows in the same order.
pub(super) fn out_of_fold(table: &Table, settings: &LearningSettings) -> (Vec<usize>, Vec<Vec<Vec<f64>>>) {
    let (mut rows, mut all): (Vec<usize>, Vec<Vec<Vec<f64>>>) = (Vec::new(), Vec::new());
    for fold in folds(table, settings.folds) {
        let models = Models::learn(&table.of_rows(&fold.learnt).known(), settings);
        let found = models.probabilities(&table.of_rows(&fold.judged));
        all.resize(found.len().max(all.len()), Vec::new());
        all.iter_mut().zip(found).for_each(|(all, p)| all.extend(p));
        rows.extend(fold.judged);
    }
    (rows, all)
}

/// A posterior, and what models of its kind say of rows whose base and law they had not learnt.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The posterior, of models of all rows.
    pub posterior: Posterior,
    /// The rows that were held out: all, each once.
    pub judged: Table,
    /// Their probabilities, at the temperature of all populations.
    pub probabilities: Vec<Vec<f64>>,
    /// Mean loss on faults in measured bases at the thresholds of the posterior.
    pub loss: f64,
}

/// Learns a posterior: the models on all rows; their shares, temperatures and the thresholds on rows that were held out.
///
/// # Errors
/// [`TableError::NotHeldOut`] where no row can be.
pub fn fit(table: &Table, settings: &LearningSettings, provenance: &str) -> Result<Fitted, TableError> {
    let (rows, held_out) = out_of_fold(table, settings);
    if rows.is_empty() {
        return Err(TableError::NotHeldOut { rows: table.rows() });
    }
    let judged = table.of_rows(&rows);
    let found = shares(&held_out, &judged.labels, &judged.weights);
    let first = mixed(&held_out, &found);
    let mixed = validated(&judged, &first);
    let temperature_of = |is: &dyn Fn(usize) -> bool| {
        let rows: Vec<usize> = (0..judged.rows()).filter(|row| is(*row)).collect();
        let p: Vec<Vec<f64>> = rows.iter().map(|row| mixed[*row].clone()).collect();
        let part = judged.of_rows(&rows);
        temperature(&p, &part.labels, &part.weights)
    };
    let mut families: Vec<&str> = judged.groups.iter().map(|group| group.family.as_str()).collect();
    families.sort_unstable();
    families.dedup();
    let mut temperatures: Vec<(String, f32)> = families
        .iter()
        .map(|family| {
            let own = temperature_of(&|row| judged.groups[row].family == *family && judged.is_known(row));
            ((*family).to_owned(), own as f32)
        })
        .collect();
    let of_all = temperature_of(&|row| judged.is_known(row));
    temperatures.push((Posterior::ALL.to_owned(), of_all as f32));
    let probabilities: Vec<Vec<f64>> = mixed.iter().map(|p| cooled(p, of_all)).collect();
    let (thresholds, loss) = thresholds(&judged, &probabilities);
    let known = table.known();
    let models = Models::learn(&known, settings);
    let share = |k: usize| found.get(k).map_or(0.0, |s| *s as f32);
    let posterior = Posterior {
        provenance: provenance.to_owned(),
        rows: known.rows(),
        prior: prior(&known),
        thresholds,
        columns: table.columns.clone(),
        classes: table.classes.clone(),
        temperatures,
        novelty: learn_novelty(table, settings.directions),
        second: {
            let known: Vec<usize> = (0..judged.rows()).filter(|row| judged.is_known(*row)).collect();
            let first: Vec<Vec<f64>> = known.iter().map(|row| first[*row].clone()).collect();
            second_stage(&judged.of_rows(&known), &first)
        },
        shares: Shares { trees: share(0), network: share(1), ranker: share(2) },
        trees: models.trees,
        network: Some(models.network),
        ranker: models.ranker,
    };
    Ok(Fitted { posterior, judged, probabilities, loss })
}

/// The thresholds of least loss on rows of measured bases; on all rows where there are none.
fn thresholds(judged: &Table, p: &[Vec<f64>]) -> (Thresholds, f64) {
    let is_measured = |row: &usize| judged.groups[*row].base != judged.groups[*row].family;
    let rows = || (0..judged.rows()).filter(|row| judged.is_known(*row));
    let mut chosen: Vec<usize> = rows().filter(is_measured).collect();
    if chosen.is_empty() {
        chosen = rows().collect();
    }
    let p: Vec<Vec<f64>> = chosen.iter().map(|row| p[*row].clone()).collect();
    let labels = judged.of_rows(&chosen).labels;
    let (found, loss) = fit_thresholds(&p, &labels, &outcomes(&judged.classes), &Losses::default());
    (Thresholds { named: single(found.named), class: single(found.class), ..found }, loss)
}

/// In the precision of the file.
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Shares of the rows by what is wrong with them.
fn prior(table: &Table) -> Prior {
    let outcomes = outcomes(&table.classes);
    let share = |outcome: Outcome| {
        let count = table.labels.iter().filter(|label| outcomes[**label] == outcome).count();
        single(count as f64 / table.rows().max(1) as f64)
    };
    Prior {
        effect: share(Outcome::Effect),
        none: share(Outcome::Nothing),
        none_of_these: share(Outcome::NoneOfThese),
    }
}
