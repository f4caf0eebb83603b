//! The trained posterior.

use super::decision::Thresholds;
use super::error::PosteriorError;
use super::network::Network;
use super::novelty::Novelty;
use super::prior::Prior;
use super::ranker::Ranker;
use super::second_stage::SecondStage;
use super::softmax::softmax;
use super::trees::Trees;
use std::collections::BTreeMap;

/// Weights of the models in the geometric mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Of the trees.
    pub trees: f32,
    /// Of the network.
    pub network: f32,
    /// Of the ranker.
    pub ranker: f32,
}

/// A trained posterior.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// Where its weights come from: command, population, date of the program.
    pub provenance: String,
    /// Rigs that it was trained on.
    pub rows: usize,
    /// How common causes are among these.
    pub prior: Prior,
    /// From which probabilities on a cause is reported, fitted to rigs that were held out.
    pub thresholds: Thresholds,
    /// Names of the columns, in the order of a row.
    pub columns: Vec<String>,
    /// Names of the outcomes.
    pub classes: Vec<String>,
    /// Boosted trees.
    pub trees: Trees,
    /// The network, where there is one.
    pub network: Option<Network>,
    /// The ranker, where there is one.
    pub ranker: Option<Ranker>,
    /// Weights in the geometric mean.
    pub shares: Shares,
    /// The second stage, where classes have fits.
    pub second: Option<SecondStage>,
    /// Temperatures by population: probabilities are raised to the power `1/T`.
    pub temperatures: Vec<(String, f32)>,
    /// Distance to the training population.
    pub novelty: Novelty,
}

/// Least probability of a model in the geometric mean.
const LEAST: f64 = 1e-6;

impl Posterior {
    /// The name of all populations together.
    pub const ALL: &'static str = "all";
    /// The name of the outcome that nothing is missing.
    pub const NOTHING: &'static str = "none";
    /// The name of the outcome that something without a name is.
    pub const NONE_OF_THESE: &'static str = "unexplained";

    /// Values in the order of the columns.
    ///
    /// # Errors
    /// [`PosteriorError`] where a column is missing, unknown or not finite.
    pub fn row(&self, named: &[(&str, f64)]) -> Result<Vec<f64>, PosteriorError> {
        let by_name: BTreeMap<&str, f64> = named.iter().copied().collect();
        let value = |column: &String| {
            let value = by_name.get(column.as_str()).copied();
            let value = value.ok_or_else(|| PosteriorError::MissingColumn(column.clone()))?;
            let finite = value.is_finite().then_some(value);
            finite.ok_or_else(|| PosteriorError::NotFinite { column: column.clone(), value })
        };
        let row = self.columns.iter().map(value).collect::<Result<Vec<f64>, _>>()?;
        // All columns are there: a further name is one that the posterior does not know.
        if by_name.len() > self.columns.len() {
            let is_known = |name: &&&str| self.columns.iter().any(|column| column == **name);
            let unknown = by_name.keys().find(|name| !is_known(name)).copied().unwrap_or_default();
            return Err(PosteriorError::UnknownColumn(unknown.to_owned()));
        }
        Ok(row)
    }

    /// Probabilities of the outcomes of a [row](Self::row), not recalibrated; they sum to one.
    pub fn raw(&self, row: &[f64]) -> Vec<f64> {
        let by_trees = softmax(&self.trees.scores(row));
        let mut logs = vec![0.0; self.classes.len()];
        let mut add = |share: f32, p: &[f64]| {
            logs.iter_mut().zip(p).for_each(|(l, p)| *l += f64::from(share) * libm::log(p.max(LEAST)));
        };
        add(self.shares.trees, &by_trees);
        if let Some(network) = &self.network {
            add(self.shares.network, &softmax(&network.scores(row)));
        }
        if let Some(ranker) = &self.ranker {
            add(self.shares.ranker, &ranker.probabilities(row));
        }
        let first = softmax(&logs);
        let nothing = self.classes.iter().position(|class| class == Self::NOTHING);
        match &self.second {
            Some(second) => second.probabilities(row, &first, nothing),
            None => first,
        }
    }

    /// Probabilities of the outcomes of a [row](Self::row) from a population; they sum to one.
    ///
    /// # Errors
    /// [`PosteriorError::UnknownPopulation`].
    pub fn probabilities(&self, row: &[f64], population: &str) -> Result<Vec<f64>, PosteriorError> {
        let found = self.temperatures.iter().find(|(name, _)| name == population);
        let (_, temperature) = found.ok_or_else(|| {
            let known: Vec<&str> = self.temperatures.iter().map(|(name, _)| name.as_str()).collect();
            PosteriorError::UnknownPopulation { name: population.to_owned(), known: known.join(", ") }
        })?;
        let cooled = |p: &f64| libm::log(p.max(f64::MIN_POSITIVE)) / f64::from(*temperature);
        Ok(softmax(&self.raw(row).iter().map(cooled).collect::<Vec<f64>>()))
    }
}
