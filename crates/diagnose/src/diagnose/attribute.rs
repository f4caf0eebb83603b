//! From a plan to its conclusion.

use super::evidence::Evidence;
use super::nominal::Nominal;
use super::plan::Plan;
use super::report::Conclusion;
use super::rig_evidence::RigEvidence;
use crate::attribution::SIGNIFICANT;
use crate::attribution::explain::Hypothesis;
use crate::attribution::pairs::Pair;
use crate::effect::Effect;
use crate::posterior::{Classification, Fits, FittedEffect, PosteriorError};
use crate::residuals::omnibus::{Omnibus, omnibus};
use crate::verdict::answer::{Status, Verdict};
use crate::verdict::decide::{held_out_differs, unresolved};
use crate::verdict::odds::{IMMATERIAL, Odds, holds_together, of_pair};
use crate::workers::Workers;

impl Plan {
    /// Fits effects, joins the probabilities by the fits, and draws the conclusion.
    ///
    /// # Errors
    /// [`PosteriorError`] where the posterior was trained with other columns.
    pub(super) fn attribute(
        &mut self,
        workers: &impl Workers,
        evidence: &RigEvidence<'_>,
    ) -> Result<(Conclusion, Classification), PosteriorError> {
        match self.weighs_likelihoods() {
            true => self.by_likelihoods(workers, evidence),
            false => Ok(self.by_evidence(workers, evidence.classification()?)),
        }
    }

    /// The conclusion where the structure of the model is chosen: by evidence, which the fit that leads confirms.
    fn by_evidence(
        &mut self,
        workers: &impl Workers,
        classification: &Classification,
    ) -> (Conclusion, Classification) {
        self.keep_likeliest(classification);
        let mut singles = self.gather(workers).all;
        singles.retain(|single| classification.probability(single.effect_terms[0].effect) > 0.0);
        let by_evidence = self.concluded(singles, classification);
        let leading = classification.leading_fit(&self.compared(workers, &by_evidence));
        let classification = classification.clone().joined_by(leading);
        (self.concluded(by_evidence.singles, &classification), classification)
    }

    /// Leaves the likeliest effects to be fitted, those with which they are confounded, and the colour of the noise, which may stand in for any.
    fn keep_likeliest(&mut self, classification: &Classification) {
        let head = classification.head(&self.settings);
        let is_beside = |effect: &Effect| {
            effect.card().colours_noise || head.iter().any(|e| e.confounded_effects().contains(effect))
        };
        self.settings.effects.retain(|effect| head.contains(effect) || is_beside(effect));
    }

    /// The conclusion where the structure of the model is known: by the likelihoods of all fits, and of two effects together. Evidence counts where these do
    /// not decide.
    fn by_likelihoods(
        &mut self,
        workers: &impl Workers,
        evidence: &RigEvidence<'_>,
    ) -> Result<(Conclusion, Classification), PosteriorError> {
        let mut found = self.gather(workers);
        if let Some(better) = self.on_the_grid_of(&found.best) {
            self.found_on(better);
            found = self.gather(workers);
        }
        let fits = self.fits(&found);
        let before = match fits.decide() {
            true => evidence.prior(),
            false => evidence.classification()?.clone(),
        };
        let classification = before.joined_by_likelihoods(fits);
        let mut conclusion = self.concluded(found.all.clone(), &classification);
        if conclusion.verdict.status == Status::Unexplained {
            let points_at = found.tests.as_ref().and_then(Omnibus::stage);
            conclusion.verdict.stage = points_at.or(conclusion.verdict.stage);
            if self.resolves_no_gap(&conclusion.augmented.fit) {
                conclusion.verdict = unresolved(&conclusion.odds);
            }
        }
        if let Some(pair) = &found.pair {
            conclusion.together = Some(self.together(workers, pair, &self.gains(&found.ranked)));
            self.join_pair(pair, &found, &mut conclusion);
        }
        conclusion.verdict.calibrated = self.is_calibrated;
        Ok((conclusion, classification))
    }

    /// What the fits say of each effect, and what the best leaves.
    fn fits(&self, evidence: &Evidence) -> Fits {
        let samples = self.dataset.fit_samples();
        let left = evidence.tests.as_ref().map_or(0.0, |tests| tests.against(samples));
        let best = evidence.best.effects();
        let misses = !best.is_empty()
            && (self.hardly_closes(&evidence.best, left) || self.misses_at_places(&evidence.best));
        let fit = |s: &Hypothesis| {
            let effect = s.effect_terms[0].effect;
            FittedEffect {
                effect,
                gain: self.nominal.plain.bic() - s.evidence(),
                is_refuted: evidence.refuted.contains(&effect) || misses && best.contains(&effect),
            }
        };
        Fits { effects: evidence.all.iter().map(fit).collect(), left: (left - IMMATERIAL).max(0.0) }
    }

    /// Drops of the penalised deviance, the best first.
    fn gains(&self, fits: &[Hypothesis]) -> Vec<(Effect, f64)> {
        fits.iter().map(|s| (s.effect_terms[0].effect, self.nominal.plain.bic() - s.bic())).collect()
    }

    /// Two effects that hold together take the place of one.
    fn join_pair(&self, pair: &Pair, evidence: &Evidence, conclusion: &mut Conclusion) {
        let samples = self.dataset.fit_samples();
        let hypothesis = &pair.hypothesis;
        let causes = pair.causes(&self.gains(&evidence.ranked), samples);
        let has_tails = causes.effects.iter().any(|e| e.card().heavy_tails);
        let holds = holds_together(pair, samples)
            && self.better_held_out(hypothesis, &evidence.best)
            && !self.hardly_closes(hypothesis, pair.left)
            && !self.worsens(hypothesis)
            && !self.degrades_validation(hypothesis)
            && self.second_shows(hypothesis, &causes, &evidence.all)
            && !(has_tails && self.misses_at_places(hypothesis))
            && (!pair.is_hidden || self.shows_in_simulations(hypothesis));
        if !holds {
            return;
        }
        conclusion.singles.clone_from(&evidence.ranked);
        let effects = conclusion.singles.iter().map(|s| s.effect_terms[0].effect);
        (conclusion.verdict, conclusion.odds) = of_pair(&causes, effects);
        conclusion.augmented = hypothesis.clone();
        conclusion.left = pair.left;
    }

    /// The nominal model on the grid of the best candidate, where that is smooth, though it seemed to follow refinements, and the effect
    /// gains nothing on it: the borders are curved, and the effect only rides on the knots.
    fn on_the_grid_of(&self, best: &Hypothesis) -> Option<Nominal> {
        let least = self.nominal.plain.bic() - SIGNIFICANT;
        best.without_effect_terms(&self.dataset).filter(|alone| alone.bic() < least)?;
        let smooth = best.on_a_smooth_grid(&self.dataset)?;
        let plain = smooth.without_effect_terms(&self.dataset).filter(|alone| alone.bic() < least)?;
        let rides = smooth.bic() > plain.bic() - SIGNIFICANT;
        let detailed =
            [&plain, &self.nominal.detailed].into_iter().min_by(|x, y| x.bic().total_cmp(&y.bic()))?.clone();
        rides.then_some(Nominal { plain, detailed })
    }

    /// What the posterior says, shown by the fit of the effect that comes first.
    fn concluded(&self, singles: Vec<Hypothesis>, classification: &Classification) -> Conclusion {
        let probability = |s: &Hypothesis| classification.probability(s.effect_terms[0].effect);
        let odds = Odds {
            effects: singles.iter().map(probability).collect(),
            none: classification.none,
            unexplained: classification.unexplained(),
        };
        let nominal = &self.nominal.plain;
        let mut verdict = classification.verdict();
        if verdict.status == Status::None
            && let Some(ratio) = self.held_out_errors_beyond_chance(&nominal.fit)
        {
            let calibrated = verdict.calibrated;
            verdict = Verdict { calibrated, ..held_out_differs(&odds, ratio) };
        }
        // Of a list the first whose repair makes no held-out record worse beyond its error.
        let listed = verdict.effects.iter().chain(&verdict.class);
        let fits = listed.filter_map(|effect| singles.iter().find(|s| s.effect_terms[0].effect == *effect));
        let is_named = verdict.status == Status::Named;
        let shown = fits.into_iter().find(|s| is_named || !self.degrades_validation(s));
        let augmented = shown.unwrap_or(nominal).clone();
        let samples = self.dataset.fit_samples();
        let left = omnibus(&self.dataset, &augmented.fit).map_or(0.0, |tests| tests.against(samples));
        Conclusion {
            fitted: singles.clone(),
            singles,
            odds,
            verdict,
            augmented,
            left,
            together: None,
            other: None,
        }
    }
}
