//! The draws of one effect, one after the other.

use super::{Context, Draw, Plan, Staircase};
use crate::examination::scramble;
use crate::generate::Precision;

/// An effect, its draws so far, and what they say.
#[derive(Debug, Clone)]
pub(crate) struct Search {
    /// The effect.
    pub effect: &'static str,
    /// The draws.
    pub draws: Vec<Draw>,
    /// What they say.
    pub staircase: Staircase,
    seed: u64,
}

/// So many refusals in a row, and no more is tried.
const REFUSED: usize = 3;

impl Search {
    /// No draw yet; `guess` is how often the effect is reported where it is not.
    pub(crate) fn new(effect: &'static str, guess: f64, plan: &Plan) -> Self {
        Self { effect, draws: Vec::new(), staircase: Staircase::new(guess), seed: plan.seed_of(effect) }
    }

    /// One draw more.
    pub(crate) fn step(&mut self, context: &Context<'_>) {
        let seed = scramble(self.seed, self.draws.len() as u64);
        // The staircase takes the size that is reached, whatever was asked for.
        let draw = context.draw(Precision::COARSE, (self.effect, self.staircase.next_size()), seed);
        self.take(draw);
    }

    /// Takes a draw in.
    pub(super) fn take(&mut self, draw: Draw) {
        if let Draw::Diagnosed { fault, answer } = &draw {
            self.staircase.push(fault.size, answer.is_found());
        }
        self.draws.push(draw);
    }

    /// Whether no draw is needed any more: it is settled, cannot be put in, or had the most draws.
    pub(crate) fn is_done(&self, plan: &Plan) -> bool {
        let last = &self.draws[self.draws.len().saturating_sub(REFUSED)..];
        let is_refused = last.len() == REFUSED && last.iter().all(|draw| matches!(draw, Draw::Refused(_)));
        is_refused || self.draws.len() >= plan.most() || self.staircase.conclusion().is_settled()
    }
}
