//! The search for two effects: a forward step from several firsts, then a restart from each member of the best pair.

use super::Firsts;
use super::pair_search::{PairSearch, RESTARTS};
use crate::attribution::explain::Hypothesis;
use crate::attribution::{Attribution, PairEffort};
use crate::effect::Effect;
use crate::workers::Workers;

/// First effects that a second one is looked for on top of before the restarts, and the share of the best gain that a
/// further one needs.
const SEEDS: usize = 3;
const SEED: f64 = 0.25;
/// Further firsts while much is left.
const CONFOUNDED_EFFECTS: usize = 2;
/// Single effects beside which refinements of the borders are looked for.
const DETAILED: usize = 6;
/// Share of the gap that the best pair may leave after the restarts: another law of its members seldom takes more.
const FAR: f64 = 0.2;
/// Times that laws and knots are sought in turn, and the share of what was left from which on another time finds the same.
const ROUNDS: usize = 2;
const UNMOVED: f64 = 0.9;

impl<W: Workers> Attribution<'_, W> {
    /// The best pair by a forward step and restarts.
    ///
    /// The first effect of the best pair is seldom the best single one: a third may imitate both. So each member of the
    /// best pair found is in turn held while every other effect is tried beside it; where much is left, or noise of any
    /// colour stands in for the rest, also with the dynamics identified anew; then confounded effects of the firsts, while much is left;
    /// then every law of both members and their confounded effects, and border knots placed anew, with which another law may serve better. No
    /// knot saves a hopeless pair, and where a pair leaves nothing there is nothing to look for. [`PairEffort`] may end it sooner.
    pub(super) fn searched(&self, singles: Firsts<'_>) -> Option<Hypothesis> {
        let serious = self.serious(singles);
        let mut search = PairSearch::new(self, singles);
        search.refinement(&serious[..serious.len().min(DETAILED)]);
        for &effect in &serious {
            let is_confounded = search.tried.iter().any(|t| t.confounded_effects().contains(&effect));
            // A confounded effect of what was tried finds the same seconds.
            let may_gain = search.tried.is_empty() || !search.is_whole();
            if search.tried.len() < SEEDS && !is_confounded && may_gain {
                search.step(effect);
            }
        }
        search.restart();
        match self.pair_effort {
            PairEffort::Full => {}
            PairEffort::WhileHopeful if !search.is_hopeless() => {}
            PairEffort::WhileHopeful => return search.found.into_iter().next(),
            PairEffort::Forward => {
                search.place_knots_anew();
                return search.found.into_iter().next();
            }
        }
        if search.leaves_much() || search.is_coloured() {
            search.afresh();
        }
        if search.is_hopeless() {
            return search.found.into_iter().next();
        }
        for &effect in &serious {
            if search.tried.len() < SEEDS + RESTARTS + CONFOUNDED_EFFECTS
                && search.leaves_much()
                && !search.tried.contains(&effect)
            {
                search.step(effect);
            }
        }
        search.restart();
        for _ in 0..ROUNDS {
            let before = search.left_of_gap();
            let was_near = before < FAR;
            if was_near && !search.is_whole() {
                search.every_law();
            }
            search.prefer_what_leaves_less();
            search.place_knots_anew();
            let left = search.left_of_gap();
            if left >= FAR || left > UNMOVED * before || !search.leaves_much() {
                break;
            }
        }
        search.found.into_iter().next()
    }

    /// Effects that gain a good part of what the best one does, best first. Heavy tails stand in for whatever else is missing: they
    /// are serious where nothing that may be the cause gains more.
    fn serious(&self, singles: Firsts<'_>) -> Vec<Effect> {
        let gained = |s: &Hypothesis| self.gain(Some(s));
        let most = self.gain(singles.ranked.first());
        let is_tails = |s: &&Hypothesis| s.effect_terms[0].effect.card().heavy_tails;
        let tails = singles.all.iter().filter(is_tails).filter(|s| gained(s) >= most);
        let others = singles.ranked.iter().filter(|s| !is_tails(s) && gained(s) > SEED * most);
        tails.chain(others).map(|s| s.effect_terms[0].effect).collect()
    }
}
