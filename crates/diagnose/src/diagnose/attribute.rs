//! From a plan to its conclusion.

use super::evidence::Evidence;
use super::nominal::Nominal;
use super::plan::Plan;
use super::report::Conclusion;
use crate::attribution::SIGNIFICANT;
use crate::attribution::explain::Hypothesis;
use crate::effect::Effect;
use crate::residuals::omnibus::omnibus;
use crate::verdict::answer::Status;
use crate::verdict::decide::{held_out_differs, parameters_are_off, unresolved, verdict, without_colour};
use crate::verdict::odds::{Residuals, holds_together, odds, odds_together};
use crate::verdict::simulators::weighed_by_closure;
use crate::workers::Workers;

/// What is reported noise whose colour is no cause.
const COLOURED: &str = "the errors of the equation are coloured, as they are wherever nobody designed the records: that belongs to the model; \
                        ask for coloured_noise to have it reported as a cause";

impl Plan {
    /// The nominal model on the grid of the best candidate, where that is smooth, though it seemed to follow refinements, and the effect
    /// gains nothing on it: the borders are curved, and the effect only rides on the knots.
    fn on_the_grid_of(&self, best: &Hypothesis) -> Option<Nominal> {
        if self.dataset.holds_nominal() {
            return None;
        }
        let least = self.nominal.plain.bic() - SIGNIFICANT;
        best.without_effect_terms(&self.dataset).filter(|alone| alone.bic() < least)?;
        let smooth = best.on_a_smooth_grid(&self.dataset)?;
        let plain = smooth.without_effect_terms(&self.dataset).filter(|alone| alone.bic() < least)?;
        let rides = smooth.bic() > plain.bic() - SIGNIFICANT;
        let detailed =
            [&plain, &self.nominal.detailed].into_iter().min_by(|x, y| x.bic().total_cmp(&y.bic()))?.clone();
        rides.then_some(Nominal { plain, detailed })
    }

    /// Ranks the candidates and draws the conclusions.
    pub(super) fn attribute(&mut self, workers: &impl Workers) -> Conclusion {
        if let Some(nothing) = self.nothing_to_explain() {
            return nothing;
        }
        let mut evidence = self.gather(workers);
        if let Some(better) = self.on_the_grid_of(&evidence.best) {
            self.found_on(better);
            evidence = self.gather(workers);
        }
        let rivals = evidence.rivals();
        let Evidence { all, mut singles, ranked: members, outdone, significant, best, mut tests, pair } =
            evidence;
        let samples = self.dataset.fit_samples();
        let mut left = tests.as_ref().map_or(0.0, |tests| tests.against(samples));
        // The tests of one-step predictions say nothing about simulators.
        let deviance = if self.dataset.criterion.simulates() { 0.0 } else { left };
        let refuted =
            significant && (outdone || self.hardly_closes(&best, left) || self.misses_at_places(&best));
        let leaves = Residuals { deviance, gap: self.gap_left(&best.fit), refuted };
        // What harms is no cause, and a rival all the same: what it would get goes to none of these.
        let mut odds = odds(self.nominal.plain.bic(), &rivals, leaves);
        odds.unexplained += odds.effects.drain(singles.len()..).sum::<f64>();
        let mut joint = None;
        let of_members = |of: &dyn Fn(&Hypothesis) -> f64| -> Vec<(Effect, f64)> {
            members.iter().map(|s| (s.effect_terms[0].effect, of(s))).collect()
        };
        let gains = of_members(&|s| self.nominal.plain.bic() - s.bic());
        let found = pair.as_ref().map(|pair| self.together(workers, pair, &gains));
        if let Some(pair) = pair.filter(|pair| holds_together(pair, samples)) {
            let causes = pair.causes(&gains, samples);
            let together =
                odds_together(self.nominal.plain.bic(), &pair, &causes, &of_members(&Hypothesis::evidence));
            let (hypothesis, pair_left) = (pair.hypothesis, pair.left);
            let has_tails = causes.effects.iter().any(|e| e.card().heavy_tails);
            let misses = has_tails && self.misses_at_places(&hypothesis);
            let holds = self.better_held_out(&hypothesis, &best)
                && !self.hardly_closes(&hypothesis, pair_left)
                && !self.worsens(&hypothesis)
                && !self.degrades_validation(&hypothesis)
                && self.second_shows(&hypothesis, &causes, &all)
                && !misses
                && (!pair.is_hidden || self.shows_in_simulations(&hypothesis));
            if together.reported() >= self.settings.name_at && holds {
                tests = omnibus(&self.dataset, &hypothesis.fit);
                (left, odds, joint) = (pair_left, together, Some((hypothesis, causes)));
                singles = members;
            }
        }
        let reported = joint.as_ref().map_or(&best, |(hypothesis, _)| hypothesis);
        let odds = match self.held_out_closure(&reported.fit) {
            Some(closure) if significant => weighed_by_closure(odds, closure),
            _ => odds,
        };
        let reported = &joint.as_ref().map_or(&best, |(hypothesis, _)| hypothesis).effect_terms;
        if self.owns_colour
            && significant
            && reported.iter().any(|effect_term| effect_term.effect.card().colours_noise)
        {
            self.limitations.push(COLOURED.into());
        }
        let odds = match joint.is_none() && self.owns_colour {
            true => odds.with_colour_in_the_model(singles.iter().map(|s| s.effect_terms[0].effect)),
            false => odds,
        };
        let mut ranked: Vec<(Effect, f64)> =
            singles.iter().zip(&odds.effects).map(|(s, p)| (s.effect_terms[0].effect, *p)).collect();
        ranked.sort_by(|x, y| y.1.total_cmp(&x.1));
        let causes = joint.as_ref().map(|(_, causes)| causes);
        let mut verdict = verdict(&ranked, &odds, causes, tests.as_ref(), &self.settings);
        let hypothesis = joint.map_or(best, |(hypothesis, _)| hypothesis);
        if self.owns_colour {
            verdict = without_colour(verdict);
        }
        if self.only_parameters_are_off(verdict.status, &hypothesis.fit) {
            verdict = parameters_are_off(&verdict);
        } else if verdict.status == Status::Unexplained && self.resolves_no_gap(&hypothesis.fit) {
            verdict = unresolved(&odds);
        } else if verdict.status == Status::None
            && let Some(ratio) = self.held_out_errors_beyond_chance(&self.nominal.plain.fit)
        {
            verdict = held_out_differs(&odds, ratio);
        }
        verdict.calibrated = self.is_calibrated;
        let augmented = match verdict.status {
            Status::None | Status::Refit => self.nominal.plain.clone(),
            _ => hypothesis,
        };
        Conclusion { fitted: all, singles, odds, verdict, augmented, left, together: found, other: None }
    }
}
