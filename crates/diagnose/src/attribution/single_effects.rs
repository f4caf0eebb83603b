//! Every effect on its own, and border knots placed anew for those that may be the cause.

use super::successive_halving::Halving;
use super::{Attribution, SIGNIFICANT};
use crate::attribution::explain::Hypothesis;
use crate::attribution::search::{Question, reidentified};
use crate::attribution::starts::Known;
use crate::effect::Effect;
use crate::nominal::knots::refinement;
use crate::workers::Workers;

/// Effects fitted to convergence at least.
const FINISHED: usize = 4;
/// Candidates whose knots are placed anew at most where none follows a refinement, and the share of the best gain that they need.
const REPLACED: usize = 3;
const RIVAL: f64 = 0.85;
/// Share of an effect's gain that refinements of the borders gain without it, from which it rides on them.
const RIDES: f64 = 0.9;

impl<W: Workers> Attribution<'_, W> {
    /// Every effect on its own, best first.
    pub(crate) fn singles(&self) -> Vec<Hypothesis> {
        let all: Vec<Question> = self.settings.effects.iter().map(|e| Question::open(*e)).collect();
        let mut singles = self.on_top_of(self.detailed, &all, Halving { finished: FINISHED, to_beat: None });
        if self.settings.consider_refinement() {
            self.compare_with_refinement(&mut singles);
        }
        if !self.dataset.holds_nominal() && self.gain(singles.first()) > 0.5 * SIGNIFICANT {
            singles = self.knots_placed_anew(singles);
        }
        singles
    }

    /// Effects that may rule the input or the errors, with the dynamics identified anew: those that come near the best of the
    /// singles.
    pub(crate) fn dominant_reidentified(&self, singles: &[Hypothesis]) -> Vec<Hypothesis> {
        let known = Known::new(self.dataset, self.detailed);
        let asked: Vec<Effect> = self.dominant_effects().collect();
        let found = self.workers.map(&asked, |effect| reidentified(&known, *effect));
        let found: Vec<Hypothesis> = found.into_iter().flatten().filter(|s| self.considers(s)).collect();
        let most = found.iter().chain(singles).map(|s| self.gain(Some(s))).fold(0.0, f64::max);
        let rivals = found.into_iter().filter(|s| self.gain(Some(s)) > RIVAL * most).collect::<Vec<_>>();
        let placed = |single: &Hypothesis| self.placed_anew(single.clone());
        self.workers.map(&rivals, |single| placed(single).set_aside(self.detailed.fit.near()))
    }

    /// The effects considered that may leave nothing of what the dynamics are identified from: friction that rises or falls fast, a loop
    /// that closes, a gain that changes, a slow lag before the plant, errors that last, a line, a trend; and a delay, of which `B` takes
    /// whole samples.
    pub(crate) fn dominant_effects(&self) -> impl Iterator<Item = Effect> {
        let considered = |e: &Effect| self.settings.effects.contains(e);
        Effect::ALL.into_iter().filter(|e| e.card().dominates_dynamics).filter(considered)
    }

    /// Knots placed from the data are themselves the candidate that the grid was too coarse.
    fn compare_with_refinement(&self, singles: &mut Vec<Hypothesis>) {
        let known = Hypothesis::detailed(self.detailed.fit.clone());
        let found = singles.iter_mut().find(|s| s.effect_terms[0].effect.card().lies_in_the_grid);
        match found {
            Some(finer) if finer.bic() <= known.bic() => {}
            Some(finer) => *finer = known,
            None => singles.push(known),
        }
        singles.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
    }

    /// The nominal fit placed its knots with the effect's trace in the residual: the rivals get theirs anew.
    ///
    /// Where refinements of the borders matter beside an effect, the effect alone is the one on an even grid.
    fn knots_placed_anew(&self, singles: Vec<Hypothesis>) -> Vec<Hypothesis> {
        let most = self.gain(singles.first());
        // Where knots follow a refinement, every effect has what they gain.
        let replaced = if self.has_refinement() { singles.len() } else { REPLACED };
        let numbered: Vec<(usize, Hypothesis)> = singles.into_iter().enumerate().collect();
        let mut out = self.workers.map(&numbered, |(rank, single)| {
            let is_grid = single.effect_terms[0].effect.card().lies_in_the_grid;
            let rival = *rank < replaced && self.gain(Some(single)) > SIGNIFICANT.max(RIVAL * most);
            match (is_grid, rival) {
                (true, _) => single.clone(),
                (false, true) => self.placed_anew(single.clone()).set_aside(self.detailed.fit.near()),
                (false, false) if self.has_refinement() => single.clone().set_back(SIGNIFICANT),
                (false, false) => single.clone(),
            }
        });
        out.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
        out
    }

    /// Whether the nominal model lacks refinements of the borders.
    fn has_refinement(&self) -> bool {
        self.nominal.fit.grid != self.detailed.fit.grid
    }

    /// An effect alone, border knots placed anew: none follow refinements, which are an effect of their own.
    fn placed_anew(&self, single: Hypothesis) -> Hypothesis {
        self.without_refinement(single.with_knots_refined(self.dataset))
    }

    /// Border knots placed anew, and none that follow refinements where those are no candidate.
    pub(crate) fn knots_refined(&self, hypothesis: Hypothesis) -> Hypothesis {
        match self.settings.consider_refinement() {
            true => hypothesis.with_knots_refined(self.dataset),
            false => self.placed_anew(hypothesis),
        }
    }

    /// The candidate on an even grid, where the refinements that its knots follow are material.
    pub(crate) fn without_refinement(&self, single: Hypothesis) -> Hypothesis {
        match self.evenly(&single) {
            Some(even) if even.bic() - single.bic() > refinement(self.dataset) => even,
            _ => single,
        }
    }

    /// The candidate on an even grid: a smooth one where the effect gains little that refinements of the borders do not. Elsewhere
    /// smooth borders may seem rough because the nonlinear parameters are a little off.
    fn evenly(&self, single: &Hypothesis) -> Option<Hypothesis> {
        let even = single.on_an_even_grid(self.dataset)?;
        let gained_by_refinement = self.gain(Some(self.detailed));
        match gained_by_refinement > RIDES * self.gain(Some(&even)) {
            true => single.on_a_smooth_grid(self.dataset),
            false => Some(even),
        }
    }
}
