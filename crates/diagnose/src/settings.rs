//! What is diagnosed, and how.

use crate::effect::Effect;
use crate::nominal_model::NominalModel;
use crate::posterior::{Posterior, Prior};
use std::sync::Arc;
use switchback_model::Record;

/// Knobs of a diagnosis; the defaults are the calibrated ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The effects to consider.
    pub effects: Vec<Effect>,
    /// Effects that are reported as a cause though they belong to the model of such records: the colour of noise, where nobody designed these.
    pub asked: Vec<Effect>,
    /// Largest order tried where the rig declares none.
    pub max_order: usize,
    /// Only models that could run in real time: no look ahead, and a reversal takes effect once it is confirmed.
    pub causal: bool,
    /// Most effects named together.
    pub max_effects: usize,
    /// How common causes are where the records were taken; as among the rigs that the posterior was trained on, if not given.
    pub prior: Option<Prior>,
    /// The posterior that decides; the [built-in](Posterior::built_in) one, if not given.
    pub posterior: Option<Arc<Posterior>>,
    /// Probability up to which its likeliest effects are fitted, and most of these.
    pub head: f64,
    /// Most effects that are fitted after it.
    pub most_fitted: usize,
    /// Seed of the block bootstrap.
    pub seed: u64,
    /// Resamples of the block bootstrap.
    pub resamples: usize,
}

impl Settings {
    /// The same with some effects left out.
    #[must_use]
    pub fn without(mut self, effects: &[Effect]) -> Self {
        self.effects.retain(|effect| !effects.contains(effect));
        self
    }

    /// The same with some effects asked for.
    #[must_use]
    pub fn asking(mut self, effects: &[Effect]) -> Self {
        self.asked.extend(effects);
        self
    }

    /// The posterior that decides.
    pub(crate) fn posterior(&self) -> &Posterior {
        self.posterior.as_deref().unwrap_or_else(|| Posterior::built_in())
    }

    /// Whether an effect is none of those to consider.
    pub(crate) fn is_left_out(&self, effect: Effect) -> bool {
        !self.effects.contains(&effect)
    }

    /// Whether an effect is no cause of records that nobody designed: it was left out, or is the colour of their noise and nobody asked for it.
    pub(crate) fn is_no_cause(&self, effect: Effect) -> bool {
        self.is_left_out(effect) || effect.card().colours_noise && !self.asked.contains(&effect)
    }

    /// Whether refinements of the borders are a candidate: elsewhere no knots may follow them.
    pub(crate) fn consider_refinement(&self) -> bool {
        self.effects.iter().any(|effect| effect.card().lies_in_the_grid)
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            effects: Effect::ALL.to_vec(),
            asked: Vec::new(),
            max_order: 4,
            causal: false,
            max_effects: 2,
            prior: None,
            posterior: None,
            head: 0.98,
            most_fitted: 5,
            seed: 1,
            resamples: 400,
        }
    }
}

/// Which model meets the records.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Model {
    /// The nominal model is identified from the fit records.
    #[default]
    Identify,
    /// This model, as it is.
    Given(NominalModel),
    /// The records' `y_sim`: the prediction of any other simulator.
    Predicted,
    /// Records of another machine, or of the same on another day: what differs between both is asked.
    Against(Vec<Record>),
}
