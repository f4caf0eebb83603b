//! A trained posterior: from named columns of evidence to probabilities of all outcomes.
//!
//! The weights are data ([`Posterior::read`]), written by a command of the laboratory. Evaluation is plain arithmetic in a fixed order. The
//! probabilities are a weighted geometric mean of [boosted trees](Trees), a [network](Network) and a [ranker](Ranker), which a
//! [second stage](SecondStage) joins with the likelihood of fits, raised to a power that was fitted to a population; a [fit that leads](LeadingFit) on the user's own records joins
//! them, or, where the structure of the model is known, the [likelihoods](Likelihoods) of all fits.
//! [`Novelty`] is the distance of a row from the training population, [`decide`] gives the report.

mod built_in;
mod bytes;
mod classification;
mod decision;
mod error;
mod file;
mod leading_fit;
mod likelihoods;
mod network;
mod novelty;
mod prior;
mod ranker;
mod second_stage;
mod softmax;
mod standard;
mod trees;
mod weights;

pub use classification::{Cause, Classification};
pub use decision::{Decision, Losses, Outcome, Thresholds, decide};
pub use error::PosteriorError;
pub use file::VERSION;
pub use leading_fit::LeadingFit;
pub use likelihoods::{Fits, FittedEffect, Likelihoods, Probabilities, Weights};
pub use network::{Layer, Network};
pub use novelty::Novelty;
pub use prior::Prior;
pub use ranker::Ranker;
pub use second_stage::SecondStage;
pub use softmax::softmax;
pub use standard::Standard;
pub use trees::{Node, Tree, Trees};
pub use weights::{Posterior, Shares};

#[cfg(test)]
mod tests;
