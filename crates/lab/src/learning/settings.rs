//! How a posterior is learnt.

use super::boosting_settings::BoostingSettings;
use super::network::NetworkSettings;

/// How a posterior is learnt.
#[derive(Debug, Clone, PartialEq)]
pub struct LearningSettings {
    /// Boosted trees of all classes.
    pub trees: BoostingSettings,
    /// The network.
    pub network: NetworkSettings,
    /// Boosted trees of the ranker.
    pub ranker: BoostingSettings,
    /// Directions of the distance to the training population.
    pub directions: usize,
    /// Folds by family, and by law: their product is the number of folds.
    pub folds: usize,
}

impl Default for LearningSettings {
    fn default() -> Self {
        Self {
            trees: BoostingSettings::default(),
            network: NetworkSettings::default(),
            ranker: BoostingSettings {
                rounds: 250,
                leaves: 31,
                rate: 0.06,
                least_rows: 20,
                ..BoostingSettings::default()
            },
            directions: 20,
            folds: 3,
        }
    }
}
