//! A second effect: a forward step from several firsts, then a restart from each member of the best pair.

use crate::attribution::{Attribution, Contest, detail};
use crate::diagnosis::Together;
use crate::effect::Effect;
use crate::explain::Explanation;
use crate::omnibus::{Omnibus, omnibus};
use crate::search::Question;
use crate::workers::Workers;

/// Two effects together.
#[derive(Debug, Clone)]
pub(crate) struct Pair {
    pub(crate) explanation: Explanation,
    /// Penalised deviance gained over the best single effect.
    pub(crate) gain: f64,
    /// Deviance that causes in general would still gain beside both, and beside the best single effect.
    pub(crate) left: f64,
    pub(crate) left_by_single: f64,
    /// Whether the best single effect rounds so coarsely that the tests are blind to a second one.
    pub(crate) is_hidden: bool,
}

/// Single effects to start from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Firsts<'a> {
    /// Those that may be the cause by themselves, best first.
    pub(crate) ranked: &'a [Explanation],
    /// Every one that was fitted.
    pub(crate) all: &'a [Explanation],
}

impl Together {
    /// `gains` are those of the single effects over the nominal model, the best first.
    pub(crate) fn of(pair: &Pair, gains: &[(Effect, f64)]) -> Self {
        let effects = pair.explanation.effects();
        let alone = |effect: &Effect| gains.iter().find(|g| g.0 == *effect).map_or(0.0, |g| g.1.max(0.0));
        let both = pair.gain + gains.first().map_or(0.0, |g| g.1);
        let (shares, interaction) = Self::shapley(both, [alone(&effects[0]), alone(&effects[1])]);
        Self {
            effects,
            gain: pair.gain,
            left: pair.left,
            left_by_single: pair.left_by_single,
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

/// First effects that a second one is looked for on top of before the restarts, and the share of the best gain that a
/// further one needs.
const SEEDS: usize = 3;
const SEED: f64 = 0.25;
/// Restarts from members of the best pair at most, and further firsts while much is left.
const RESTARTS: usize = 2;
const TWINS: usize = 2;
/// Single effects beside which details of the borders are looked for.
const DETAILED: usize = 6;
/// Share of the gap that the best pair of the first steps may leave: one that holds leaves a tenth of that at most.
const HOPELESS: f64 = 0.3;
/// Share of the best pair's gain that comes near it, and how many pairs every law is tried for.
const NEAR: f64 = 0.9;
const NEARBY: usize = 2;
/// Pairs fitted to convergence on each first effect.
const FINISHED: usize = 3;
/// Share of the innovations' variance that no rounding makes, below which the tests are blind to whatever else there is.
const HIDDEN: f64 = 0.5;
/// Deviance left a sample from which a second effect is looked for.
const WORTH_A_LOOK: f64 = 0.03;

impl<W: Workers> Attribution<'_, W> {
    /// The best pair of effects, where the best single one leaves something that a second may explain.
    pub(crate) fn pair(&self, singles: Firsts<'_>, tests: &Omnibus) -> Option<Pair> {
        let best_single = singles.ranked.first()?;
        let worth_a_look = WORTH_A_LOOK * self.campaign.fit_samples() as f64;
        let is_hidden = tests.unrounded < HIDDEN;
        let explanation = if tests.excess() <= worth_a_look && tests.tails > worth_a_look {
            self.with_outliers(best_single)?
        } else if tests.excess() > worth_a_look || is_hidden {
            self.searched(singles)?
        } else {
            return None;
        };
        let gain = best_single.bic() - explanation.bic();
        let left = omnibus(self.campaign, &explanation.fit).map_or(f64::INFINITY, |o| o.excess());
        Some(Pair { explanation, gain, left, left_by_single: tests.excess(), is_hidden })
    }

    /// Outliers beside a first effect: the only cause that leaves nothing but heavy tails.
    fn with_outliers(&self, first: &Explanation) -> Option<Explanation> {
        let present = first.parts[0].effect;
        let outliers = Effect::Outliers;
        let other = present != outliers && !present.twins().contains(&outliers);
        (other && self.settings.effects.contains(&outliers))
            .then(|| {
                let alone = Contest { finished: 1, to_beat: None };
                self.on_top_of(first, &[Question::open(outliers)], alone)
            })
            .and_then(|pairs| pairs.into_iter().next())
    }

    /// The best pair by a forward step and restarts.
    ///
    /// The first effect of the best pair is seldom the best single one: a third may imitate both. So each member of the
    /// best pair found is in turn held while every other effect is tried beside it; then twins of the firsts, while much is
    /// left; then every law of both members and their twins; and border knots placed anew. No knot saves a hopeless pair.
    fn searched(&self, singles: Firsts<'_>) -> Option<Explanation> {
        let best_single = singles.ranked.first()?;
        let gained = |s: &Explanation| self.nominal.bic() - s.bic();
        let serious: Vec<Effect> = (singles.ranked.iter())
            .filter(|s| gained(s) > SEED * gained(best_single))
            .map(|s| s.parts[0].effect)
            // Heavy tails stand in for whatever else is missing.
            .filter(|e| *e != Effect::Outliers || *e == best_single.parts[0].effect)
            .collect();
        let mut search =
            Search { of: self, singles, tried: Vec::new(), detailed: Vec::new(), found: Vec::new() };
        search.details(&serious[..serious.len().min(DETAILED)]);
        for &effect in &serious {
            let is_twin = search.tried.iter().any(|t| t.twins().contains(&effect));
            // A twin of what was tried finds the same seconds.
            if search.tried.len() < SEEDS && !is_twin {
                search.step(effect);
            }
        }
        search.restart();
        if search.is_hopeless() {
            return search.found.into_iter().next();
        }
        for &effect in &serious {
            if search.tried.len() < SEEDS + RESTARTS + TWINS
                && search.leaves_much()
                && !search.tried.contains(&effect)
            {
                search.step(effect);
            }
        }
        search.restart();
        search.every_law();
        search.found.into_iter().next().map(|best| best.with_knots_refined(self.campaign))
    }
}

/// A search for two effects under way.
struct Search<'a, 'b, W> {
    of: &'a Attribution<'b, W>,
    singles: Firsts<'a>,
    /// Firsts that seconds were looked for on.
    tried: Vec<Effect>,
    /// Firsts that details of the borders were looked for on.
    detailed: Vec<Effect>,
    /// Pairs found, the best first: of every two effects the best.
    found: Vec<Explanation>,
}

impl<W: Workers> Search<'_, '_, W> {
    /// Looks for the best second beside a first.
    fn step(&mut self, first: Effect) {
        self.tried.push(first);
        let others = self.of.settings.effects.iter().filter(|e| is_another(first, **e));
        let questions: Vec<Question> =
            others.map(|e| self.single(*e).map_or_else(|| Question::open(*e), Question::after)).collect();
        self.ask(first, &questions);
        self.details(&[first]);
    }

    /// Details of the borders beside each first: the knots that follow them, placed with the effect known.
    fn details(&mut self, firsts: &[Effect]) {
        let of = self.of;
        if !of.settings.effects.contains(&Effect::BorderResolution) {
            return;
        }
        let is_new = |e: &&Effect| **e != Effect::BorderResolution && !self.detailed.contains(e);
        let firsts: Vec<Effect> = firsts.iter().filter(is_new).copied().collect();
        let singles: Vec<&Explanation> = firsts.iter().filter_map(|e| self.single(*e)).collect();
        let found = of.workers.map(&singles, |first| {
            let detailed = (*first).clone().with_details(of.campaign);
            (first.bic() - detailed.bic() > detail(of.campaign)).then_some(detailed)
        });
        self.detailed.extend(firsts);
        self.consider(found.into_iter().flatten());
    }

    /// Adds to the pairs found.
    fn consider(&mut self, pairs: impl IntoIterator<Item = Explanation>) {
        self.found.extend(pairs);
        self.found.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
        let mut seen: Vec<[Effect; 2]> = Vec::new();
        self.found.retain(|pair| {
            let both = members(pair);
            let new = !seen.contains(&both);
            seen.push(both);
            new
        });
    }

    /// The best pair found.
    fn best(&self) -> Option<&Explanation> {
        self.found.first()
    }

    /// Steps from members of the best pair that were no firsts yet.
    fn restart(&mut self) {
        for _ in 0..RESTARTS {
            let members = self.best().map_or_else(Vec::new, Explanation::effects);
            let Some(next) = members.into_iter().find(|e| !self.tried.contains(e)) else { break };
            self.step(next);
        }
    }

    /// Every law of both members and of their twins, of the best pair and of one that comes near it.
    fn every_law(&mut self) {
        let gain = |pair: &Explanation| self.of.nominal.bic() - pair.bic();
        let Some(most) = self.best().map(gain) else { return };
        let near: Vec<[Effect; 2]> =
            self.found.iter().filter(|pair| gain(pair) > NEAR * most).take(NEARBY).map(members).collect();
        for [one, other] in near {
            for (held, moved) in [(one, other), (other, one)] {
                let alike = std::iter::once(&moved).chain(moved.twins());
                let considered = |e: &&Effect| is_another(held, **e) && self.of.settings.effects.contains(e);
                let questions: Vec<Question> = alike.filter(considered).map(|e| Question::open(*e)).collect();
                self.ask(held, &questions);
            }
        }
    }

    /// Deviance left by the best pair; infinite where there is none.
    fn left(&self) -> f64 {
        let of_pair = |best: &Explanation| omnibus(self.of.campaign, &best.fit).map_or(0.0, |o| o.excess());
        self.best().map_or(f64::INFINITY, of_pair)
    }

    /// Whether the best pair is so far from the whole that none will be.
    fn is_hopeless(&self) -> bool {
        let Some(best) = self.best() else { return true };
        let left = self.left();
        left > HOPELESS * (left + self.of.nominal.bic() - best.bic())
    }

    /// Whether so much is left that another first may find a better pair.
    fn leaves_much(&self) -> bool {
        self.left() > WORTH_A_LOOK * self.of.campaign.fit_samples() as f64
    }

    fn ask(&mut self, first: Effect, questions: &[Question]) {
        let Some(first) = self.single(first) else { return };
        let to_beat = self.best().map(Explanation::bic);
        let contest = Contest { finished: FINISHED, to_beat };
        let second = self.of.on_top_of(first, questions, contest).into_iter().next();
        self.consider(second);
    }

    fn single(&self, effect: Effect) -> Option<&Explanation> {
        self.singles.all.iter().find(|s| s.parts[0].effect == effect)
    }
}

/// Both effects of a pair, in one order.
fn members(pair: &Explanation) -> [Effect; 2] {
    let mut both = [pair.parts[0].effect, pair.parts[1].effect];
    both.sort_unstable();
    both
}

/// Whether an effect may stand beside a first: details of the borders and large errors here and there take what any inexact
/// law leaves, and what a twin adds is the difference between two laws of one thing.
fn is_another(first: Effect, second: Effect) -> bool {
    let is_stopgap = matches!(second, Effect::BorderResolution | Effect::Outliers);
    second != first && !first.twins().contains(&second) && !is_stopgap
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
