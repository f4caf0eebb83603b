//! What is asked of a diagnosis.

use std::sync::Arc;
use switchback_diagnose::posterior::{Posterior, Prior};
use switchback_diagnose::{Effect, Settings};

/// What the user knows of the rig and wants of its models.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// Effects that the rig is known not to have.
    pub without: Vec<Effect>,
    /// Effects to show as a cause where else they belong to the model.
    pub ask: Vec<Effect>,
    /// Whether nominal models must be able to run in real time.
    pub causal: bool,
    /// How common causes are on machines like this one.
    pub prior: Option<Prior>,
    /// The posterior that decides on records that nobody designed, where there is one.
    pub posterior: Option<Arc<Posterior>>,
}

impl Request {
    /// How the records are diagnosed.
    pub fn settings(&self) -> Settings {
        Settings {
            prior: self.prior,
            posterior: self.posterior.clone(),
            causal: self.causal,
            ..Settings::default().without(&self.without).asking(&self.ask)
        }
    }
}
