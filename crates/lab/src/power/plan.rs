//! What is asked for.

use crate::examination::scramble;
use crate::generate::EFFECTS;

/// Effects, draws and the seed of all that is random.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// Effects to put in, each once.
    pub effects: Vec<&'static str>,
    /// Draws an effect on average, at least 1; as many diagnoses are made without fault.
    pub draws: usize,
    /// Seed of everything.
    pub seed: u64,
}

/// An effect whose draws do not settle it takes over those of settled ones, up to this many times its own.
const MOST: usize = 4;

impl Plan {
    /// Draws with a fault, at most.
    pub fn budget(&self) -> usize {
        self.effects.len() * self.draws
    }

    /// Diagnoses, at most.
    pub fn diagnoses(&self) -> usize {
        self.budget() + self.draws
    }

    /// Draws of one effect, at most.
    pub(crate) fn most(&self) -> usize {
        MOST * self.draws
    }

    /// Seed of the draws of an effect, whatever others are asked for.
    pub fn seed_of(&self, effect: &str) -> u64 {
        let number = EFFECTS.iter().position(|known| *known == effect).unwrap_or(EFFECTS.len());
        scramble(self.seed, number as u64)
    }

    /// Seed of a diagnosis without fault.
    pub(crate) fn seed_of_bare(&self, number: usize) -> u64 {
        scramble(scramble(self.seed, EFFECTS.len() as u64 + 1), number as u64)
    }
}
