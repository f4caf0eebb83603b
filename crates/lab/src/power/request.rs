//! What is asked of a measurement of power.

use super::{Plan, PowerError};
use crate::generate::EFFECTS;
use std::ops::RangeInclusive;
use switchback_diagnose::Settings;

/// Which effects are put in, how often, and from which seed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// Effects to put in; all that are candidates where none is named.
    pub effects: Vec<&'static str>,
    /// Faults an effect, on average.
    pub draws: usize,
    /// Laws, parameters and noise are drawn from this.
    pub seed: u64,
}

impl Default for Request {
    fn default() -> Self {
        Self { effects: Vec::new(), draws: 6, seed: 1 }
    }
}

impl Request {
    /// How many faults an effect may take, on average.
    pub const DRAWS: RangeInclusive<u64> = 1..=1000;

    /// The plan, each effect once, where the candidates are those of the settings.
    ///
    /// # Errors
    /// [`PowerError::Draws`] for too many faults or none, [`PowerError::NoEffect`] where no effect is left.
    pub fn plan(&self, settings: &Settings) -> Result<Plan, PowerError> {
        if !Self::DRAWS.contains(&(self.draws as u64)) {
            return Err(PowerError::Draws(self.draws));
        }
        let is_candidate = |name: &&'static str| settings.effects.iter().any(|effect| effect.name() == *name);
        let mut effects: Vec<&'static str> = match &self.effects[..] {
            [] => EFFECTS.into_iter().filter(is_candidate).collect(),
            some => some.to_vec(),
        };
        let mut seen = Vec::new();
        effects.retain(|effect| {
            let is_new = !seen.contains(effect);
            seen.push(*effect);
            is_new
        });
        if effects.is_empty() {
            return Err(PowerError::NoEffect);
        }
        Ok(Plan { effects, draws: self.draws, seed: self.seed })
    }
}
