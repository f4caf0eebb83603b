//! From conclusions to the diagnosis that is handed out.

use super::Plan;
use super::given_model::GivenModel;
use super::parameters::parameters;
use crate::attribution::explain::Explanation;
use crate::attribution::pairs::Pair;
use crate::attribution::search::profiled;
use crate::closure::{Simulated, measure};
use crate::diagnosis::{
    Candidate, Cell, Diagnosis, Figure, FittedParameter, Gap, HoldoutSeries, Models, Refit, Status, Together,
    Verdict,
};
use crate::effect::Effect;
use crate::export::PortableModel;
use crate::likelihood::engine::Fit;
use crate::localise::{Residuals, localise};
use crate::nominal::order::Structure;
use crate::phase::Phase;
use crate::residuals::horizons::Reference;
use crate::residuals::score::{innovations, picture};
use crate::simulation::simulate::runs_away;
use crate::verdict::odds::Odds;
use crate::workers::Workers;

/// What the report is made of.
pub(super) struct Conclusion {
    pub(super) singles: Vec<Explanation>,
    pub(super) odds: Odds,
    pub(super) verdict: Verdict,
    pub(super) augmented: Explanation,
    pub(super) left: f64,
    pub(super) together: Option<Together>,
    /// The nominal model of another structure that is the answer: order, delay, its runs of the judged records and the noise that it
    /// leaves in these.
    pub(super) other: Option<Other>,
}

/// What candidates are compared with.
struct Compared {
    /// The nominal model on the fit records.
    horizons: Reference,
    /// Variance of the noise in the output and its relative standard error.
    floor: (f64, f64),
    /// Log score of the nominal model on the held-out records.
    score: Option<f64>,
}

/// A nominal model of another structure.
pub(super) struct Other {
    pub(super) structure: Structure,
    pub(super) runs: Vec<Vec<f64>>,
    pub(super) floor: (f64, f64),
}

impl Plan {
    pub(super) fn report(self, workers: &impl Workers, c: Conclusion) -> Diagnosis {
        workers.begin(Phase::Report);
        let campaign = &self.campaign;
        let mut floor = self.noise_floor(&c.augmented.fit);
        let mut runs = self.simulations(&c.augmented.fit);
        if let Some(other) = &c.other {
            floor = other.floor;
            runs.iter_mut().zip(&other.runs).for_each(|(run, other)| run.after.clone_from(other));
        }
        let mut limitations = self.limitations.clone();
        let mut gap = measure(campaign, &runs, floor, (self.settings.seed, self.settings.resamples));
        gap.identified_anew = self.identified_anew(floor);
        if self.given.is_some() && gap.before.ci90[0] > 1.0 {
            limitations.push(
                "the model under diagnosis misses the judged records by more than their mean does: compare its units, its sample \
                 time and its coefficients with the rig's"
                    .into(),
            );
        }
        let nominal_score = self.score(&self.nominal.plain.fit);
        gap.predictive_gain =
            self.score(&c.augmented.fit).zip(nominal_score).map_or(0.0, |(after, before)| after - before);
        if campaign.criterion.simulates() {
            // Nobody predicted one step ahead.
            gap.predictive_gain = 0.0;
        }
        if gap.closure.is_none() {
            limitations.push(
                "the interval of the gap on the judged records includes zero: not resolvable, so no closure is given"
                    .into(),
            );
        }
        let mut verdict = c.verdict;
        match verdict.status {
            Status::None => gap.closure = None,
            Status::Refit => {
                let structure = c.other.as_ref().map_or(self.structure, |other| other.structure);
                let told = |closure| Refit { order: structure.order, delay: -structure.lead, closure };
                verdict.refit = gap.closure.map(told);
            }
            _ => {}
        }
        let weighed: Vec<(&Explanation, &f64)> = c.singles.iter().zip(&c.odds.effects).collect();
        let nominal =
            Compared { horizons: Reference::of(&self.nominal.plain.fit), floor, score: nominal_score };
        let mut candidates = workers.map(&weighed, |(s, p)| self.candidate(s, **p, &nominal));
        let is_told = |effect| verdict.effects.contains(&effect) || verdict.class.contains(&effect);
        for (candidate, single) in candidates.iter_mut().zip(&c.singles).filter(|(c, _)| is_told(c.effect)) {
            candidate.parameters = parameters(campaign, (single, 0), &profiled(workers, campaign, single));
        }
        candidates.sort_by(|x, y| {
            y.probability.total_cmp(&x.probability).then(y.delta_bic.total_cmp(&x.delta_bic))
        });
        let where_ = self.map(&c.augmented.fit, floor.0);
        let before = picture(campaign, &innovations(campaign, &self.nominal.plain.fit, |t| t.is_fit()));
        let after = picture(campaign, &innovations(campaign, &c.augmented.fit, |t| t.is_fit()));
        let added = self.added(&c.augmented, &candidates, c.together.as_ref());
        let next_experiment = crate::experiments::propose(campaign, &verdict, &c.singles, floor.0);
        Diagnosis {
            where_,
            verdict,
            gap,
            candidates,
            probability_none: c.odds.none,
            probability_unexplained: c.odds.unexplained,
            left: c.left,
            samples: campaign.fit_samples(),
            passes: campaign.passes.so_far(),
            together: c.together,
            next_experiment,
            series: self.series(&runs),
            residuals_before: before,
            residuals_after: after,
            limitations,
            models: Some(Models {
                nominal: self.nominal_model(),
                augmented: self.exporter.fitted(campaign, &c.augmented),
                added,
            }),
        }
    }

    /// The effects of the augmented model; parameters with the intervals that they are told with elsewhere, where they are.
    fn added(
        &self,
        augmented: &Explanation,
        candidates: &[Candidate],
        together: Option<&Together>,
    ) -> Vec<(Effect, Vec<FittedParameter>)> {
        let effects = augmented.effects();
        let told = match effects[..] {
            [only] => candidates.iter().find(|c| c.effect == only).map(|c| vec![c.parameters.clone()]),
            _ => together.filter(|pair| pair.effects == effects).map(|pair| pair.parameters.clone()),
        };
        let intervals = augmented.fit.intervals();
        let fitted = |number: usize| parameters(&self.campaign, (augmented, number), &intervals);
        let all: Vec<_> = (0..effects.len()).map(fitted).collect();
        let values =
            |all: &[Vec<FittedParameter>]| -> Vec<f64> { all.iter().flatten().map(|p| p.value).collect() };
        // An explanation on other knots has other estimates.
        let told = told.filter(|told| values(told) == values(&all));
        effects.into_iter().zip(told.unwrap_or(all)).collect()
    }

    /// The model under diagnosis; nothing where only its predictions are known.
    fn nominal_model(&self) -> Option<PortableModel> {
        match &self.given {
            Some(given) => given.fit.as_ref().map(|fit| self.exporter.given(&self.campaign, fit)),
            None => Some(self.exporter.fitted(&self.campaign, &self.nominal.plain)),
        }
    }

    /// `G²` of the identified nominal model, where another was given.
    fn identified_anew(&self, floor: (f64, f64)) -> Option<Figure> {
        self.given.as_ref()?;
        let runs = self.simulations(&self.nominal.plain.fit);
        Some(measure(&self.campaign, &runs, floor, (self.settings.seed, self.settings.resamples)).after)
    }

    /// Where the model under diagnosis misses: as it was given, or else the identified nominal one. `noise` is the variance of the
    /// noise in the output.
    fn map(&self, augmented: &Fit, noise: f64) -> Vec<Cell> {
        let floor = self.innovation_floor(augmented);
        match &self.given {
            Some(GivenModel { residuals, is_output: true, .. }) => localise(&self.campaign, residuals, noise),
            Some(GivenModel { residuals, .. }) => localise(&self.campaign, residuals, floor),
            None => localise(&self.campaign, &Residuals::of(&self.campaign, &self.nominal.plain.fit), floor),
        }
    }

    fn candidate(&self, s: &Explanation, p: f64, nominal: &Compared) -> Candidate {
        let effect = s.parts[0].effect;
        let runs = self.simulations(&s.fit);
        let Gap { before, closure, after, .. } =
            measure(&self.campaign, &runs, nominal.floor, (self.settings.seed, 0));
        let unstable = runs_away(&s.fit, runs.iter().map(|run| &run.after[..]));
        let closure = closure.filter(|_| !unstable).map(|_| 1.0 - after.estimate / before.estimate);
        Candidate {
            effect,
            stage: effect.stage(),
            probability: p,
            parameters: parameters(&self.campaign, (s, 0), &s.fit.intervals()),
            bic: s.bic(),
            delta_bic: self.nominal.plain.bic() - s.bic(),
            heldout_log_score: self.score(&s.fit).zip(nominal.score).map_or(0.0, |(a, b)| a - b),
            gains: nominal.horizons.gains(&s.fit),
            closure,
            unstable,
        }
    }

    /// What is told of a pair; `gains` are those of the single effects over the nominal model, the best first.
    pub(super) fn together(&self, workers: &impl Workers, pair: &Pair, gains: &[(Effect, f64)]) -> Together {
        let (campaign, both) = (&self.campaign, &pair.explanation);
        let intervals = profiled(workers, campaign, both);
        let parameters = (0..both.parts.len()).map(|number| parameters(campaign, (both, number), &intervals));
        Together::of(pair, gains, parameters.collect())
    }

    fn series(&self, runs: &[Simulated]) -> Vec<HoldoutSeries> {
        let c = &self.campaign;
        let physical = |y: &[f64]| y.iter().map(|y| c.y_mean + c.y_scale * y).collect::<Vec<f64>>();
        runs.iter()
            .map(|run| HoldoutSeries {
                record: c.tracks[run.number].name.clone(),
                measured: physical(&c.tracks[run.number].y),
                nominal: physical(&run.before),
                augmented: physical(&run.after),
            })
            .collect()
    }
}
