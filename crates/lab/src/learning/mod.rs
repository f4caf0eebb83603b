//! Training of the posterior: boosted trees, a network and a ranker on a table of evidence, compared on folds that share neither where a rig
//! comes from nor the law of its cause.
//!
//! Everything is deterministic: draws come from seeded streams, sums have a fixed order, threads only share out whole classes and columns.
//! What is trained is evaluated by [`switchback_diagnose::posterior`].

mod binned;
mod boosting;
mod boosting_settings;
mod calibration;
mod combined;
mod comparison;
mod folds;
mod grower;
mod network;
mod novelty;
mod populations;
mod ranker;
mod scores;
mod second_stage;
mod settings;
mod standardised;
mod table;
mod thresholds;

pub use binned::Binned;
pub use boosting::{Target, boost};
pub use boosting_settings::BoostingSettings;
pub use combined::{Fitted, Models, fit};
pub use comparison::{Compared, compare};
pub use folds::{Fold, folds};
pub use network::{NetworkSettings, train_network};
pub use populations::{Population, populations};
pub use scores::{Scores, scores};
pub use settings::LearningSettings;
pub use table::{Group, Table, TableError, Truth};
pub use thresholds::{fit_thresholds, outcomes};

#[cfg(test)]
mod tests;
