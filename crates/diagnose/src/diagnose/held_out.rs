//! What the held-out records say about the candidates.

use super::plan::Plan;
use crate::attribution::explain::Hypothesis;
use crate::closure::measure;
use crate::diagnosis::Gap;
use crate::effect::Effect;
use crate::likelihood::engine::Fit;
use crate::records::dataset::Criterion;
use crate::records::repeats::Repeating;
use crate::residuals::clustering::come_where_the_input_is;
use crate::residuals::omnibus::omnibus;
use crate::residuals::quantisation_grid::worth;
use crate::residuals::score::heldout_log_score;
use crate::simulation::simulate::free_run;
use crate::verdict::odds::IMMATERIAL;
use crate::workers::Workers;
use switchback_model::spectrum::mean_square;

/// Simulation error on held-out records, over that of the model without the effect, from which a fit has run away.
const RUNAWAY: f64 = 20.0;
/// Share of the simulation error that may repeat with the input under a candidate by noise.
const REPEATS: f64 = 0.12;
/// Share of the simulation error that another effect must leave for noise to remain a cause, and of the noise's gain that
/// it must gain to be heard.
const SYSTEMATIC: f64 = 0.88;
const SERIOUS: f64 = 0.2;

/// Log score a sample that is no difference.
const AS_GOOD: f64 = 0.01;
/// Share of another's simulation error that is clearly less: a log score hangs on the few samples beside a jump.
const CLEARLY: f64 = 0.9;

/// Log score a sample that a model has for the quantisation grid it puts the outputs on, of which their density knows nothing.
pub(super) fn reported_by_rounding(fit: &Fit) -> f64 {
    fit.augmented.noise.quantisation.map_or(0.0, |_| 0.5 * worth(1))
}

/// Share of the gap that a candidate closes which is its cause: the upper end of the interval lies above.
const MATERIAL: f64 = 0.5;

impl Plan {
    /// The held-out records have their say: what a candidate loses on them in log score counts like a loss in
    /// deviance. Slow changes may be followed where they were fitted and still lead nowhere beyond.
    pub(super) fn validation_penalty(&self, workers: &impl Workers, singles: &mut [Hypothesis]) {
        let Some(nominal) = self.score(&self.nominal.plain.fit) else { return };
        let held_out = self.dataset.scaled_records.iter().filter(|t| !t.is_fit());
        let samples = held_out.map(|t| t.v.len().saturating_sub(t.from)).sum::<usize>() as f64;
        let heard = workers.map(singles, |s| (self.score(&s.fit), self.simulation_error(&s.fit)));
        // Simulators are no safer for beating the nominal model: what they lose to the best of them counts.
        let reference = match self.dataset.criterion {
            Criterion::OneStep => nominal,
            Criterion::Simulation { .. } => heard.iter().filter_map(|h| h.0).fold(nominal, f64::max),
        };
        let nominal_error = self.simulation_error(&self.nominal.plain.fit);
        for (single, (score, error)) in singles.iter_mut().zip(heard) {
            let lost = score.map_or(0.0, |s| reference - s);
            let excused = single.effect_terms.iter().any(|p| p.effect.is_of_its_record());
            single.held_out = if excused { 0.0 } else { 2.0 * samples * lost.max(0.0) };
            if error > RUNAWAY * nominal_error {
                // What runs away on other records is no account of these either.
                single.held_out += (self.nominal.plain.bic() - single.bic()).max(0.0);
            }
        }
        singles.sort_by(|x, y| x.evidence().total_cmp(&y.evidence()));
    }

    /// Whether one candidate predicts the held-out records better than another; true without any, and for effects of
    /// their own record, which need not hold in others.
    pub(super) fn better_held_out(&self, one: &Hypothesis, than: &Hypothesis) -> bool {
        let excused = one.effects().iter().any(|e| e.is_of_its_record());
        let (error, other) = (self.simulation_error(&one.fit), self.simulation_error(&than.fit));
        let score = |e: &Hypothesis| self.score(&e.fit).map(|score| score + reported_by_rounding(&e.fit));
        let scores = score(one).zip(score(than));
        error < RUNAWAY * other
            && (excused || error < CLEARLY * other || scores.is_none_or(|(one, other)| one > other - AS_GOOD))
    }

    /// Noise moves no simulation error: where much of the error repeats with the input under the best noise candidate, or
    /// an effect that does move it takes much of it away on the held-out records, the noise is no cause of it, however
    /// well it predicts one step ahead.
    pub(super) fn drop_noise_where_the_gap_is_systematic(&self, singles: &mut Vec<Hypothesis>) {
        let Some(best) = singles.first().filter(|s| s.effect_terms[0].effect.is_noise()) else { return };
        // Noise that lasts makes simulation errors of any size, and leaves nothing.
        let lasts = best.effect_terms[0].effect.card().colours_noise;
        if lasts && omnibus(&self.dataset, &best.fit).is_some_and(|left| left.excess() < IMMATERIAL) {
            return;
        }
        let mut repeating = Repeating::default();
        for (number, scaled) in self.dataset.scaled_records.iter().enumerate() {
            let run = free_run(&self.dataset, &best.fit, number, scaled);
            let error: Vec<f64> = scaled.y.iter().zip(&run).map(|(y, run)| y - run).collect();
            repeating.add(scaled, &error);
        }
        let error = |s: &Hypothesis| self.simulation_error(&s.fit);
        let gained = self.nominal.plain.evidence() - best.evidence();
        let rivals = singles.iter().filter(|s| {
            let effect = s.effect_terms[0].effect;
            let serious = self.nominal.plain.evidence() - s.evidence() > SERIOUS * gained;
            serious && !effect.is_noise() && !effect.is_of_its_record()
        });
        let least = rivals.map(error).fold(f64::INFINITY, f64::min);
        let repeats = repeating.share().is_some_and(|share| share > REPEATS);
        if repeats || least < SYSTEMATIC * error(best) {
            singles.retain(|s| !s.effect_terms[0].effect.is_noise());
        }
    }

    /// What is worse on held-out records explains nothing, however well it follows those it was fitted to: a simulator that closes none
    /// of the gap, and whatever degrades a record beyond its error.
    pub(super) fn refuted(&self, workers: &impl Workers, singles: &[Hypothesis]) -> Vec<Effect> {
        let is_refuted = |s: &Hypothesis| {
            self.held_out_closure(&s.fit).is_some_and(|closure| closure <= 0.0) || self.degrades_validation(s)
        };
        let refuted = workers.map(singles, is_refuted);
        let effects = singles.iter().map(|s| s.effect_terms[0].effect);
        effects.zip(refuted).filter_map(|(effect, is_refuted)| is_refuted.then_some(effect)).collect()
    }

    /// Share of the gap that a model closes on the judged records, where models are compared as simulators and there is a
    /// gap.
    pub(super) fn held_out_closure(&self, fit: &Fit) -> Option<f64> {
        if !self.dataset.criterion.simulates() {
            return None;
        }
        let before = mean_square(&self.errors(|number| self.run_before(number)));
        let after = mean_square(&self.judged_errors(fit));
        let noise = self.unforeseeable(fit).0;
        (before > noise).then(|| (before - after) / (before - noise))
    }

    /// Whether there is a gap on the judged records that a candidate does not close, though a cause would.
    ///
    /// Effects that depend on time, or on a phase that differs from record to record, need not close it. Nor do random effects whose errors last, and
    /// noise that leaves no deviance (`left`): coloured noise alone makes a simulation differ from the record.
    pub(super) fn hardly_closes(&self, hypothesis: &Hypothesis, left: f64) -> bool {
        let excused = |e: &Effect| e.is_of_its_record() || e.card().errors_last;
        let effects = hypothesis.effects();
        let whole = left < IMMATERIAL && effects.iter().all(|e| e.is_noise());
        if self.dataset.criterion.simulates() || effects.iter().any(excused) || whole {
            return false;
        }
        let gap = self.gap(&hypothesis.fit, self.settings.resamples);
        gap.closure.is_some_and(|closure| closure.ci90[1] < MATERIAL)
    }

    /// Whether a candidate makes the simulation of the held-out records worse beyond chance. Candidates that consist of noise are exempt, and so
    /// are effects that depend on time beside others that do not.
    pub(super) fn worsens(&self, hypothesis: &Hypothesis) -> bool {
        let effects = hypothesis.effects();
        let of_its_record = effects.iter().any(|e| e.is_of_its_record());
        let lasting = effects.iter().any(|e| !e.is_noise() && !e.is_of_its_record());
        let all_noise = !of_its_record && !lasting;
        let excused = all_noise || of_its_record && lasting;
        let closure = || self.gap(&hypothesis.fit, self.settings.resamples).closure;
        !excused && closure().is_some_and(|closure| closure.ci90[1] < 0.0)
    }

    /// Whether outliers that explain the gap, alone or beside another effect, come where the input is: something is missed there.
    pub(super) fn misses_at_places(&self, hypothesis: &Hypothesis) -> bool {
        hypothesis.effects().iter().any(|e| e.card().heavy_tails)
            && come_where_the_input_is(&self.dataset, &hypothesis.fit)
    }

    /// Whether something beside the rounding of the sensor, to which the tests are blind, shows on the judged records: what
    /// closes a gap there, unless it moves no simulation or need not hold in other records.
    pub(super) fn shows_in_simulations(&self, hypothesis: &Hypothesis) -> bool {
        let beside = |e: &&Effect| !e.card().rounds;
        let excused = |e: &Effect| e.is_noise() || e.is_of_its_record();
        let gap = self.gap(&hypothesis.fit, self.settings.resamples);
        hypothesis.effects().iter().filter(beside).all(excused)
            || gap.closure.is_some_and(|closure| closure.ci90[0] > MATERIAL)
    }

    /// The gap on the judged records before and after.
    pub(super) fn gap(&self, fit: &Fit, resamples: usize) -> Gap {
        let draws = (self.settings.seed, resamples);
        measure(&self.dataset, &self.simulations(fit), self.noise_floor(fit), draws)
    }

    /// Log score a sample on the held-out records: of one-step predictions, or of the simulation.
    pub(super) fn score(&self, fit: &Fit) -> Option<f64> {
        match self.dataset.criterion {
            Criterion::OneStep => heldout_log_score(&self.dataset, fit),
            Criterion::Simulation { share } => {
                Some(-0.5 * share * mean_square(&self.judged_errors(fit)).max(1e-300).ln())
            }
        }
    }

    /// [Errors](Self::judged_errors) of the free-run simulation, squared and summed over the judged records.
    pub(super) fn simulation_error(&self, fit: &Fit) -> f64 {
        self.judged_errors(fit).iter().flatten().map(|e| e * e).sum()
    }
}
