//! Which effects explain what the nominal model misses: a cheap screening of every law, then the promising ones to
//! convergence, border knots placed anew, and a second effect where the first leaves much.

pub(crate) mod explain;
pub(crate) mod pairs;
pub(crate) mod search;
mod single_effects;
pub(crate) mod starts;
mod successive_halving;

use self::explain::Hypothesis;
use crate::effect::Effect;
use crate::posterior::Likelihoods;
use crate::records::dataset::Dataset;
use crate::settings::Settings;

/// Penalised deviance that an effect must gain before anything is missing at all: covers the search over some twenty effects,
/// their laws and their nonlinear parameters.
pub(crate) const SIGNIFICANT: f64 = Likelihoods::SEARCHED;

/// What is to be explained, and with what.
pub(crate) struct Attribution<'a, W> {
    pub(crate) dataset: &'a Dataset,
    pub(crate) settings: &'a Settings,
    pub(crate) nominal: &'a Hypothesis,
    /// The nominal model with border knots placed from the data: what effects are added to.
    pub(crate) detailed: &'a Hypothesis,
    pub(crate) workers: &'a W,
    pub(crate) pair_effort: PairEffort,
}

/// How far the search for two effects goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PairEffort {
    /// Until nothing more is gained.
    Full,
    /// The dynamics are not identified anew where the forward steps leave most of the gap: models may be compared as simulators instead.
    WhileHopeful,
    /// Forward steps only. Errors of simulations never become white, so that the tests would always ask for another step; what further steps gain is
    /// small against the error of any model.
    Forward,
}

impl<W> Attribution<'_, W> {
    /// Whether all effects of a candidate are to be considered, each once: signs may have given a law the name of another.
    pub(crate) fn considers(&self, hypothesis: &Hypothesis) -> bool {
        let effects = hypothesis.effects();
        let is_new = |(number, effect): (usize, &Effect)| !effects[..number].contains(effect);
        effects.iter().all(|e| self.settings.effects.contains(e)) && effects.iter().enumerate().all(is_new)
    }

    /// Penalised deviance gained over the nominal model.
    pub(crate) fn gain(&self, hypothesis: Option<&Hypothesis>) -> f64 {
        hypothesis.map_or(0.0, |e| self.nominal.bic() - e.bic())
    }
}
