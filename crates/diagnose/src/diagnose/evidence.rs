//! What the fits say before anything is weighed.

use super::plan::Plan;
use crate::attribution::explain::Hypothesis;
use crate::attribution::pairs::{Firsts, Pair};
use crate::attribution::search::{beside_the_model, on_a_free_drift_path};
use crate::attribution::{Attribution, SIGNIFICANT};
use crate::effect::Effect;
use crate::phase::Phase;
use crate::residuals::omnibus::{Omnibus, omnibus};
use crate::verdict::odds::IMMATERIAL;
use crate::workers::Workers;

/// Single effects and the best pair of them.
#[derive(Debug)]
pub(super) struct Evidence {
    /// Every effect whose fit is one of it: what is no cause by itself may still be one of two.
    pub(super) all: Vec<Hypothesis>,
    /// The same without noise where the gap is systematic, best first.
    pub(super) ranked: Vec<Hypothesis>,
    /// Effects that held-out records, or what repeats with the input, refute as a single cause: one may still be one of two.
    pub(super) refuted: Vec<Effect>,
    /// Whether the best of them gains what chance does not.
    pub(super) significant: bool,
    /// The best that is not refuted, or the nominal model.
    pub(super) best: Hypothesis,
    /// What it leaves.
    pub(super) tests: Option<Omnibus>,
    pub(super) pair: Option<Pair>,
}

impl Plan {
    /// Fits every effect, and where much is left every two. A better optimum of a single effect that is found meanwhile
    /// counts from then on.
    pub(super) fn gather(&self, workers: &impl Workers) -> Evidence {
        workers.begin(Phase::Effects);
        let attribution = &self.attribution(workers);
        let mut evidence = self.weigh_in(attribution.workers, attribution.singles());
        if !self.dataset.holds_nominal()
            && (evidence.leaves_something() || evidence.is_coloured())
            && let Some(better) = evidence.improved(attribution.dominant_reidentified(&evidence.all))
        {
            evidence = self.weigh_in(attribution.workers, better);
        }
        if evidence.leaves_something()
            // Only the best: a free drift path follows in time whatever else changes while it passes.
            && let Some(freed) = on_a_free_drift_path(&self.dataset, &evidence.best)
            // What a free drift path is after the last record fitted nobody knows.
            && self.simulation_error(&freed.fit) < self.simulation_error(&evidence.best.fit)
            && let Some(better) = evidence.improved(vec![freed])
        {
            evidence = self.weigh_in(attribution.workers, better);
        }
        evidence.pair = self.pair(attribution, &evidence);
        if let Some(pair) = &evidence.pair
            && let Some(better) = evidence.improved(attribution.members_alone(pair))
        {
            let found = (pair.hypothesis.clone(), pair.left);
            evidence = self.weigh_in(attribution.workers, better);
            evidence.pair = evidence.tests().map(|tests| Pair::against(&evidence.best, tests, found));
        }
        evidence
    }

    /// Compares the candidates on held-out records, and tests the remaining error of the best that these do not refute.
    fn weigh_in(&self, workers: &impl Workers, singles: Vec<Hypothesis>) -> Evidence {
        let all = self.one_of_each(workers, singles);
        let significant = all.first().is_some_and(|s| s.bic() < self.nominal.plain.bic() - 0.5 * SIGNIFICANT);
        let mut ranked = all.clone();
        let mut refuted = Vec::new();
        if significant {
            self.drop_noise_where_the_gap_is_systematic(&mut ranked);
            refuted = self.refuted(workers, &ranked);
            let is_dropped = |effect: &Effect| ranked.iter().all(|s| s.effect_terms[0].effect != *effect);
            refuted.extend(all.iter().map(|s| s.effect_terms[0].effect).filter(is_dropped));
        }
        let stands = |s: &&Hypothesis| significant && !refuted.contains(&s.effect_terms[0].effect);
        let best = all.iter().find(stands).unwrap_or(&self.nominal.plain).clone();
        let tests = omnibus(&self.dataset, &best.fit);
        Evidence { all, ranked, refuted, significant, best, tests, pair: None }
    }

    fn attribution<'a, W: Workers>(&'a self, workers: &'a W) -> Attribution<'a, W> {
        Attribution {
            dataset: &self.dataset,
            settings: &self.settings,
            nominal: &self.nominal.plain,
            detailed: &self.nominal.detailed,
            workers,
            pair_effort: self.pair_effort,
        }
    }

    /// Of each effect the fit that counts, compared on held-out records.
    fn one_of_each(&self, workers: &impl Workers, mut singles: Vec<Hypothesis>) -> Vec<Hypothesis> {
        singles.retain(Hypothesis::may_be_a_cause);
        if self.owns_colour && !self.dataset.holds_nominal() {
            self.put_noise_beside_the_model(workers, &mut singles);
        }
        self.validation_penalty(workers, &mut singles);
        self.keep_one_law_of_each(&mut singles);
        singles
    }

    /// Noise moves no simulation, nor does a sensor that rounds: where fitting the model anew with them spoils that of a held-out record,
    /// they are fitted beside the model as it is. Of records that nobody designed no model is right, and robust weights may move it anywhere.
    fn put_noise_beside_the_model(&self, workers: &impl Workers, singles: &mut [Hypothesis]) {
        let is_asked = |s: &Hypothesis| s.effects().iter().all(|effect| effect.moves_no_simulation());
        let beside = |s: &Hypothesis| {
            let spoils = is_asked(s) && self.degrades_validation(s);
            spoils.then(|| beside_the_model(&self.dataset, &self.nominal.plain, s))
        };
        let found = workers.map(singles, beside);
        singles.iter_mut().zip(found).for_each(|(single, beside)| {
            if let Some(beside) = beside {
                *single = beside;
            }
        });
        singles.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
    }

    /// Several laws may bear the name of one effect. One step ahead the likelihood chooses; of simulators, what they lose on held-out
    /// records counts as well.
    fn keep_one_law_of_each(&self, singles: &mut Vec<Hypothesis>) {
        let simulates = self.dataset.criterion.simulates();
        let worth = |s: &Hypothesis| if simulates { s.evidence() } else { s.bic() };
        let all: Vec<(Effect, f64)> = singles.iter().map(|s| (s.effect_terms[0].effect, worth(s))).collect();
        let is_best = |effect: Effect, worth: f64| all.iter().all(|(e, w)| *e != effect || worth <= *w);
        singles.retain(|s| is_best(s.effect_terms[0].effect, worth(s)));
    }

    fn pair(&self, attribution: &Attribution<'_, impl Workers>, evidence: &Evidence) -> Option<Pair> {
        let tests = evidence.tests().filter(|_| self.settings.max_effects > 1)?;
        attribution.workers.begin(Phase::Pairs);
        let first = evidence.ranked.first()?;
        let is_best = first.effects() == evidence.best.effects();
        let of_first = (!is_best).then(|| omnibus(&self.dataset, &first.fit)).flatten();
        let firsts = Firsts { ranked: &evidence.ranked, all: &evidence.all };
        attribution.pair(firsts, of_first.as_ref().unwrap_or(tests))
    }
}

impl Evidence {
    /// What the best effect leaves, where there is one.
    fn tests(&self) -> Option<&Omnibus> {
        self.tests.as_ref().filter(|_| self.significant)
    }

    /// Whether the best colours the noise. Where `A` has taken the pole of a lag before the plant the noise of the equation is a
    /// moving average: `A y = B/P u + ξ ⟺ P·A y = B u + P·ξ`.
    fn is_coloured(&self) -> bool {
        self.significant && matches!(self.best.effects()[..], [only] if only.card().colours_noise)
    }

    fn leaves_something(&self) -> bool {
        self.tests().is_some_and(|tests| tests.excess() > IMMATERIAL)
    }

    /// All single effects, where others are better optima of some of them.
    fn improved(&self, others: Vec<Hypothesis>) -> Option<Vec<Hypothesis>> {
        let mut all = self.all.clone();
        let mut improved = false;
        for other in others.into_iter().filter(Hypothesis::may_be_a_cause) {
            let effect = other.effect_terms[0].effect;
            match all.iter().find(|known| known.effect_terms[0].effect == effect) {
                Some(known) if other.bic() >= known.bic() - SIGNIFICANT => continue,
                // The held-out records may yet prefer the one that was known.
                _ => all.push(other),
            }
            improved = true;
        }
        all.sort_by(|x, y| x.bic().total_cmp(&y.bic()));
        improved.then_some(all)
    }
}
