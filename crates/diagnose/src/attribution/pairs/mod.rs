//! A second effect beside the first.

mod causes;
mod pair_search;
mod steps;

pub(crate) use self::causes::Causes;

use crate::attribution::Attribution;
use crate::attribution::explain::Hypothesis;
use crate::attribution::search::{Question, finish};
use crate::attribution::successive_halving::Halving;
use crate::diagnosis::Together;
use crate::effect::Effect;
use crate::fitted_parameter::FittedParameter;
use crate::nominal::knots::refinement;
use crate::residuals::clustering::come_where_the_input_is;
use crate::residuals::omnibus::{Omnibus, omnibus};
use crate::workers::Workers;

/// Two effects together.
#[derive(Debug, Clone)]
pub(crate) struct Pair {
    pub(crate) hypothesis: Hypothesis,
    /// Penalised deviance gained over the best single effect.
    pub(crate) gain: f64,
    /// Deviance that causes in general would still gain beside both, and beside the best single effect.
    pub(crate) left: f64,
    pub(crate) left_by_single: f64,
    /// Whether the best single effect rounds so coarsely that the tests are blind to a second one.
    pub(crate) is_hidden: bool,
}

impl Pair {
    /// Two effects and what they leave, beside the best single one and what that leaves.
    pub(crate) fn against(
        best_single: &Hypothesis,
        tests: &Omnibus,
        (hypothesis, left): (Hypothesis, f64),
    ) -> Self {
        let gain = best_single.bic() - hypothesis.bic();
        Self { hypothesis, gain, left, left_by_single: tests.excess(), is_hidden: is_hidden(tests) }
    }
}

/// Single effects to start from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Firsts<'a> {
    /// Those that may be the cause by themselves, best first.
    pub(crate) ranked: &'a [Hypothesis],
    /// Every one that was fitted.
    pub(crate) all: &'a [Hypothesis],
}

impl Together {
    /// `gains` are those of the single effects over the nominal model, the best first; `parameters` those of the members.
    pub(crate) fn of(pair: &Pair, gains: &[(Effect, f64)], parameters: Vec<Vec<FittedParameter>>) -> Self {
        let effects = pair.hypothesis.effects();
        let alone = |effect: &Effect| gains.iter().find(|g| g.0 == *effect).map_or(0.0, |g| g.1.max(0.0));
        let both = pair.gain + gains.first().map_or(0.0, |g| g.1);
        let (shares, interaction) = Self::shapley(both, [alone(&effects[0]), alone(&effects[1])]);
        Self {
            effects,
            gain: pair.gain,
            left: pair.left,
            left_by_single: pair.left_by_single,
            parameters,
            shares: shares.to_vec(),
            interaction,
        }
    }

    /// Shares of two in what both gain, and their interaction, from what each gains alone.
    fn shapley(both: f64, [one, other]: [f64; 2]) -> ([f64; 2], f64) {
        let first = (both + one - other) / (2.0 * both);
        ([first, 1.0 - first], (both - one - other) / both)
    }
}

/// Share of the innovations' variance that no rounding makes, below which the tests are blind to whatever else there is.
const HIDDEN: f64 = 0.5;

/// Whether rounding hides from the tests what else there is.
fn is_hidden(tests: &Omnibus) -> bool {
    tests.unrounded < HIDDEN
}

/// Share of the best single effect's gain that another needs for outliers to hide that it is the better one, and how many are tried.
const HIDES: f64 = 0.5;
const RIVALS: usize = 6;
/// Deviance left a sample from which a second effect is looked for.
const WORTH_A_LOOK: f64 = 0.03;

impl<W: Workers> Attribution<'_, W> {
    /// Whether a deviance that a candidate leaves is worth a second look.
    fn is_worth_a_look(&self, left: f64) -> bool {
        left > WORTH_A_LOOK * self.dataset.fit_samples() as f64
    }

    /// The best pair of effects, where the best single one leaves something that a second may explain.
    pub(crate) fn pair(&self, singles: Firsts<'_>, tests: &Omnibus) -> Option<Pair> {
        let best_single = singles.ranked.first()?;
        let hypothesis = if self.is_worth_a_look(tests.excess()) {
            self.searched(singles)?
        } else if self.is_worth_a_look(tests.tails) {
            self.with_outliers(singles)?
        } else if is_hidden(tests) {
            self.searched(singles)?
        } else if come_where_the_input_is(self.dataset, &best_single.fit) {
            self.with_refinement(best_single)?
        } else {
            return None;
        };
        let left = omnibus(self.dataset, &hypothesis.fit).map_or(f64::INFINITY, |o| o.excess());
        Some(Pair::against(best_single, tests, (hypothesis, left)))
    }

    /// Each effect of a pair on its own, from where it is beside the other.
    pub(crate) fn members_alone(&self, pair: &Pair) -> Vec<Hypothesis> {
        self.workers
            .map(&[0, 1], |&number| {
                let alone = pair.hypothesis.effect_term(number, self.dataset)?;
                Some(self.without_refinement(finish(self.dataset, 0, &alone)))
            })
            .into_iter()
            .flatten()
            .collect()
    }

    /// Details of the borders beside a first effect: the knots that follow them, placed with the effect known.
    fn with_refinement(&self, first: &Hypothesis) -> Option<Hypothesis> {
        let is_new = !first.effects().iter().any(|e| e.card().lies_in_the_grid);
        let detailed = || first.clone().with_refinement(self.dataset);
        let considered = is_new && self.settings.consider_refinement();
        considered.then(detailed).filter(|detailed| first.bic() - detailed.bic() > refinement(self.dataset))
    }

    /// Outliers beside the best first effect: the only cause that leaves nothing but heavy tails. They hide which is the best alone.
    fn with_outliers(&self, singles: Firsts<'_>) -> Option<Hypothesis> {
        let outliers = self.settings.effects.iter().copied().find(|e| e.card().heavy_tails)?;
        let most = self.gain(singles.ranked.first());
        let may_have_them = |first: &&Hypothesis| {
            let present = first.effect_terms[0].effect;
            let other = present != outliers && !present.confounded_effects().contains(&outliers);
            other && self.gain(Some(first)) > HIDES * most
        };
        let firsts: Vec<&Hypothesis> = singles.ranked.iter().filter(may_have_them).take(RIVALS).collect();
        let beside = |first: &&Hypothesis| {
            let alone = Halving { finished: 1, to_beat: None };
            self.on_top_of(first, &[Question::open(outliers)], alone).into_iter().next()
        };
        let pairs = firsts.iter().filter_map(beside);
        pairs.min_by(|x, y| x.bic().total_cmp(&y.bic()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_sum_to_one_and_what_is_had_only_together_is_interaction() {
        let shared = |both: f64, one: f64, other: f64| Together::shapley(both, [one, other]);
        // Each brings its own.
        assert_eq!(shared(100.0, 75.0, 25.0), ([0.75, 0.25], 0.0));
        // One stands in for the other.
        assert_eq!(shared(100.0, 100.0, 100.0), ([0.5, 0.5], -1.0));
        // Neither is worth anything alone.
        assert_eq!(shared(100.0, 0.0, 0.0), ([0.5, 0.5], 1.0));
    }
}
