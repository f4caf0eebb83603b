//! What one comparison says of every effect.

use super::plan::Plan;
use super::report::Conclusion;
use crate::attribution::explain::Hypothesis;
use crate::closure::measure;
use crate::comparison::{Compared, Comparison, EffectEvidence};
use crate::diagnosis::Gap;
use crate::residuals::horizons::Reference;
use crate::residuals::omnibus::omnibus;
use crate::simulation::simulate::runs_away;
use crate::workers::Workers;

/// What candidates are compared with.
struct Baseline {
    /// The nominal model on the fit records.
    horizons: Reference,
    /// Variance of the noise in the output and its relative standard error.
    floor: (f64, f64),
    /// Log score of the nominal model on the held-out records.
    score: Option<f64>,
}

impl Plan {
    fn comparison(&self) -> Comparison {
        match (self.dataset.holds_nominal(), self.dataset.criterion.simulates()) {
            (true, _) => Comparison::GivenModelFixed,
            (false, true) => Comparison::Simulation,
            (false, false) => Comparison::OneStep,
        }
    }

    /// What the records say of every effect that was fitted.
    pub(super) fn compared(&self, workers: &impl Workers, c: &Conclusion) -> Compared {
        let nominal = &self.nominal.plain.fit;
        let baseline = Baseline {
            horizons: Reference::of(nominal),
            floor: self.noise_floor(&c.augmented.fit),
            score: self.score(nominal),
        };
        let samples = self.dataset.fit_samples();
        let left = omnibus(&self.dataset, nominal).map_or(0.0, |tests| tests.against(samples));
        let before = self.gap(nominal, self.settings.resamples).before;
        let mut effects = workers.map(&c.fitted, |s| self.evidence_of(s, &baseline));
        effects.sort_by(|x, y| y.delta_bic.total_cmp(&x.delta_bic));
        Compared {
            comparison: self.comparison(),
            samples,
            left_by_nominal: left,
            left_by_best: c.left,
            gap: [before.ci90[0], before.estimate],
            held_out_error_ratio: self.held_out_errors_beyond_chance(nominal),
            effects,
        }
    }

    fn evidence_of(&self, s: &Hypothesis, baseline: &Baseline) -> EffectEvidence {
        let runs = self.simulations(&s.fit);
        let Gap { before, closure, after, .. } =
            measure(&self.dataset, &runs, baseline.floor, (self.settings.seed, 0));
        let unstable = runs_away(&s.fit, runs.iter().map(|run| &run.after[..]));
        let nominal = &self.nominal.plain;
        EffectEvidence {
            effect: s.effect_terms[0].effect,
            parameters: s.fit.parameters - nominal.fit.parameters,
            delta_bic: nominal.bic() - s.bic(),
            heldout_log_score: self.score(&s.fit).zip(baseline.score).map_or(0.0, |(a, b)| a - b),
            gains: baseline.horizons.gains(&s.fit),
            closure: closure.filter(|_| !unstable).map(|_| 1.0 - after.estimate / before.estimate),
            degrades_validation: self.degrades_validation(s),
            unstable,
        }
    }
}
