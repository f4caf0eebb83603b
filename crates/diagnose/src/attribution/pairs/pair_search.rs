//! A search for two effects running: its steps, and what they found.

use super::Firsts;
use crate::attribution::Attribution;
use crate::attribution::explain::Hypothesis;
use crate::attribution::search::{Question, reidentified};
use crate::attribution::starts::Known;
use crate::attribution::successive_halving::Halving;
use crate::effect::Effect;
use crate::residuals::omnibus::omnibus;
use crate::verdict::odds::IMMATERIAL;
use crate::workers::Workers;

/// Restarts from members of the best pair at most.
pub(super) const RESTARTS: usize = 2;
/// Share of the gap that the best pair of the first steps may leave: one that holds leaves a tenth of that at most.
const HOPELESS: f64 = 0.3;
/// Share of the best pair's gain that comes near it, and how many pairs every law is tried for.
const NEAR_BEST: f64 = 0.95;
const NEARBY: usize = 3;
/// Share of a first's gain that a second gains alone, from which its law is known.
const CLEAR: f64 = 0.5;
/// Share of the best pair's gain that is close to it, and how many such pairs are compared by what they leave.
const CLOSE: f64 = 0.99;
const RIVALS: usize = 6;
/// Share of the gain by which a pair with large errors here and there must beat one without.
const CATCH_ALL: f64 = 0.01;
/// Pairs fitted to convergence on each first effect.
const FINISHED: usize = 3;
/// Times that a member of a pair is held as it is beside the other.
const ROUNDS: usize = 2;

/// A search for two effects running.
pub(super) struct PairSearch<'a, 'b, W> {
    of: &'a Attribution<'b, W>,
    singles: Firsts<'a>,
    /// Firsts that seconds were looked for on.
    pub(super) tried: Vec<Effect>,
    /// Firsts that refinements of the borders were looked for on.
    detailed: Vec<Effect>,
    /// Firsts as they were alone, and the seconds of which every law was tried on them.
    exhausted: Vec<[Effect; 2]>,
    /// Pairs found, the best first: of every two laws the best.
    pub(super) found: Vec<Hypothesis>,
}

impl<'a, 'b, W: Workers> PairSearch<'a, 'b, W> {
    pub(super) fn new(of: &'a Attribution<'b, W>, singles: Firsts<'a>) -> Self {
        let (tried, detailed, exhausted, found) = Default::default();
        Self { of, singles, tried, detailed, exhausted, found }
    }

    /// Looks for the best second beside a first.
    pub(super) fn step(&mut self, first: Effect) {
        self.tried.push(first);
        let others = self.of.settings.effects.iter().filter(|e| is_another(first, **e));
        let questions: Vec<Question> = others.map(|e| self.question(first, *e)).collect();
        self.ask(first, &questions);
        self.refinement(&[first]);
    }

    /// The law that served a second alone is asked after where it gained a share of what the first did: a weak trace is not distinguished from
    /// what the first leaves.
    fn question(&self, first: Effect, second: Effect) -> Question {
        let least = CLEAR * self.of.gain(self.single(first));
        let is_clear = |s: &&Hypothesis| self.of.gain(Some(s)) > least;
        self.single(second).filter(is_clear).map_or_else(|| Question::open(second), Question::after)
    }

    /// Details of the borders beside each first.
    pub(super) fn refinement(&mut self, firsts: &[Effect]) {
        let of = self.of;
        let is_new = |e: &&Effect| !self.detailed.contains(e);
        let firsts: Vec<Effect> = firsts.iter().filter(is_new).copied().collect();
        let singles: Vec<&Hypothesis> = firsts.iter().filter_map(|e| self.single(*e)).collect();
        let found = of.workers.map(&singles, |first| of.with_refinement(first));
        self.detailed.extend(firsts);
        self.consider(found.into_iter().flatten());
    }

    /// Adds to the pairs found. Large errors here and there take what a law misses now and then: by a little they gain more than the
    /// cause itself.
    fn consider(&mut self, pairs: impl IntoIterator<Item = Hypothesis>) {
        let of = self.of;
        let is_pair =
            |pair: &Hypothesis| pair.may_be_a_cause() && of.considers(pair) && !are_confounded_effects(pair);
        self.found.extend(pairs.into_iter().filter(is_pair));
        let rank = |pair: &Hypothesis| match members(pair).iter().any(|e| e.card().heavy_tails) {
            true => pair.bic() + CATCH_ALL * of.gain(Some(pair)).max(0.0),
            false => pair.bic(),
        };
        self.found.sort_by(|x, y| rank(x).total_cmp(&rank(y)));
        let mut seen: Vec<[(Effect, (Effect, usize)); 2]> = Vec::new();
        self.found.retain(|pair| {
            let both = laws(pair);
            let new = !seen.contains(&both);
            seen.push(both);
            new
        });
    }

    /// The best pair found.
    fn best(&self) -> Option<&Hypothesis> {
        self.found.first()
    }

    /// Steps from members of the best pair that were no firsts yet, while something is left.
    pub(super) fn restart(&mut self) {
        for _ in 0..RESTARTS {
            let members = self.best().map_or_else(Vec::new, Hypothesis::effects);
            let Some(next) = members.into_iter().find(|e| !self.tried.contains(e)) else { break };
            if self.is_whole() {
                break;
            }
            self.step(next);
        }
    }

    /// Seconds beside each member of the best pair, as it is in that, with the dynamics identified anew: what rules the input or the
    /// errors may hide behind an effect that does not.
    pub(super) fn afresh(&mut self) {
        let of = self.of;
        for _ in 0..ROUNDS {
            let Some(pair) = self.best().cloned() else { return };
            let firsts = (0..2).filter_map(|number| pair.effect_term(number, of.dataset));
            let asked: Vec<(Hypothesis, Effect)> = firsts
                .flat_map(|first| {
                    self.seconds_afresh(&pair, &first).into_iter().map(move |e| (first.clone(), e))
                })
                .collect();
            let found = of
                .workers
                .map(&asked, |(first, second)| reidentified(&Known::new(of.dataset, first), *second));
            self.consider(found.into_iter().flatten());
            if self.best().is_none_or(|best| members(best) == members(&pair)) {
                break;
            }
        }
    }

    /// The other member of a pair, and what else may rule the dynamics: behind coloured noise it would show by itself.
    fn seconds_afresh(&self, pair: &Hypothesis, first: &Hypothesis) -> Vec<Effect> {
        let present = first.effect_terms[0].effect;
        let dominant_effects = self.of.dominant_effects().filter(|_| !present.card().colours_noise);
        let mut seconds: Vec<Effect> =
            members(pair).into_iter().chain(dominant_effects).filter(|e| is_another(present, *e)).collect();
        seconds.sort_unstable();
        seconds.dedup();
        seconds
    }

    /// Whether the best pair holds noise whose colour may stand in for what rules the dynamics.
    pub(super) fn is_coloured(&self) -> bool {
        self.best().is_some_and(|pair| members(pair).iter().any(|e| e.card().colours_noise))
    }

    /// Every law of both members and of their confounded effects, for the best pairs: each in turn moves while the other is held, first as it
    /// was alone, then as it is beside the other.
    pub(super) fn every_law(&mut self) {
        let gain = |pair: &Hypothesis| self.of.gain(Some(pair));
        let Some(most) = self.best().map(gain) else { return };
        let mut near: Vec<[Effect; 2]> = Vec::new();
        for both in self.found.iter().filter(|pair| gain(pair) > NEAR_BEST * most).map(members) {
            if near.len() < NEARBY && !near.contains(&both) {
                near.push(both);
            }
        }
        for [one, other] in near {
            for (member, moved) in [(one, other), (other, one)] {
                for fixed in alike(member) {
                    self.exhaust(fixed, moved);
                }
            }
            for round in 0..ROUNDS {
                let Some(pair) = self.found.iter().find(|pair| members(pair) == [one, other]).cloned() else {
                    break;
                };
                let fixed = round % 2;
                let Some(first) = pair.effect_term(fixed, self.of.dataset) else { break };
                let moved = pair.effect_terms[1 - fixed].effect;
                self.ask_beside(&first, &self.laws_of(first.effect_terms[0].effect, moved));
            }
        }
    }

    /// Puts first, of the pairs that come close to the best, the one that with what it leaves to further causes costs least.
    pub(super) fn prefer_what_leaves_less(&mut self) {
        let gain = |pair: &Hypothesis| self.of.gain(Some(pair));
        let Some(most) = self.best().map(gain) else { return };
        let close = self.found.iter().take_while(|pair| gain(pair) > CLOSE * most).count().min(RIVALS);
        let cost = |pair: &Hypothesis| {
            pair.bic() + omnibus(self.of.dataset, &pair.fit).map_or(0.0, |tests| tests.excess())
        };
        let costs = self.of.workers.map(&self.found[..close], cost);
        let least = (0..close).min_by(|&i, &j| costs[i].total_cmp(&costs[j])).unwrap_or(0);
        self.found[..=least].rotate_right(1);
    }

    /// Border knots placed anew for the best pair.
    pub(super) fn place_knots_anew(&mut self) {
        if let Some(best) = self.found.first_mut() {
            let anew = self.of.knots_refined(best.clone());
            if anew.may_be_a_cause() {
                *best = anew;
            }
        }
    }

    /// Every law of an effect and of its confounded effects beside a first as it was alone, which is the same however often it is asked.
    fn exhaust(&mut self, fixed: Effect, moved: Effect) {
        let mut questions = self.laws_of(fixed, moved);
        questions.retain(|question| !self.exhausted.contains(&[fixed, question.effect]));
        if !questions.is_empty() {
            self.exhausted.extend(questions.iter().map(|question| [fixed, question.effect]));
            self.ask(fixed, &questions);
        }
    }

    /// Questions after every law of an effect and of its confounded effects beside another.
    fn laws_of(&self, fixed: Effect, moved: Effect) -> Vec<Question> {
        let considered = |e: &Effect| is_another(fixed, *e) && self.of.settings.effects.contains(e);
        alike(moved).filter(considered).map(Question::open).collect()
    }

    /// Deviance left by the best pair; infinite where there is none.
    fn left(&self) -> f64 {
        let of_pair = |best: &Hypothesis| omnibus(self.of.dataset, &best.fit).map_or(0.0, |o| o.excess());
        self.best().map_or(f64::INFINITY, of_pair)
    }

    /// Whether the best pair is so far from the whole that none will be.
    pub(super) fn is_hopeless(&self) -> bool {
        self.left_of_gap() > HOPELESS
    }

    /// Share of the gap that the best pair leaves.
    pub(super) fn left_of_gap(&self) -> f64 {
        let Some(best) = self.best() else { return 1.0 };
        let left = self.left();
        left / (left + self.of.gain(Some(best)))
    }

    /// Whether the best pair leaves nothing that another one, or another law of its members, could explain.
    pub(super) fn is_whole(&self) -> bool {
        self.left() <= IMMATERIAL
    }

    /// Whether so much is left that another first may find a better pair.
    pub(super) fn leaves_much(&self) -> bool {
        self.of.is_worth_a_look(self.left())
    }

    fn ask(&mut self, first: Effect, questions: &[Question]) {
        if let Some(first) = self.single(first) {
            self.ask_beside(first, questions);
        }
    }

    fn ask_beside(&mut self, first: &Hypothesis, questions: &[Question]) {
        let to_beat = self.best().map(Hypothesis::bic);
        let halving = Halving { finished: FINISHED, to_beat };
        let seconds = self.of.on_top_of(first, questions, halving).into_iter();
        self.consider(seconds.filter(Hypothesis::may_be_a_cause).take(FINISHED));
    }

    fn single(&self, effect: Effect) -> Option<&'a Hypothesis> {
        self.singles.all.iter().find(|s| s.effect_terms[0].effect == effect)
    }
}

/// Both effects of a pair, in one order.
fn members(pair: &Hypothesis) -> [Effect; 2] {
    let mut both = [pair.effect_terms[0].effect, pair.effect_terms[1].effect];
    both.sort_unstable();
    both
}

/// Both effects of a pair with the numbers of their laws, in one order.
fn laws(pair: &Hypothesis) -> [(Effect, (Effect, usize)); 2] {
    let mut both = [0, 1].map(|i| (pair.effect_terms[i].effect, pair.effect_terms[i].law));
    both.sort_unstable();
    both
}

/// Whether both are confounded effects: signs may have given a law the name of one.
fn are_confounded_effects(pair: &Hypothesis) -> bool {
    let [one, other] = members(pair);
    one.confounded_effects().contains(&other)
}

/// An effect and its confounded effects.
fn alike(effect: Effect) -> impl Iterator<Item = Effect> {
    std::iter::once(effect).chain(effect.confounded_effects().iter().copied())
}

/// Whether an effect may stand beside a first: refinements of the borders and large errors here and there take what any inexact
/// law leaves, and what a confounded effect adds is the difference between two laws of one thing.
fn is_another(first: Effect, second: Effect) -> bool {
    second != first && !first.confounded_effects().contains(&second) && !second.card().catch_all
}
