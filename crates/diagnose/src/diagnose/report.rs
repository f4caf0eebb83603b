//! From conclusions to the diagnosis that is handed out.

use super::given_model::GivenModel;
use super::parameters::parameters;
use super::plan::Plan;
use crate::attribution::explain::Hypothesis;
use crate::attribution::pairs::Pair;
use crate::attribution::search::profiled;
use crate::closure::{Simulated, closures, measure};
use crate::comparison::Compared;
use crate::diagnosis::{Candidate, Cell, Diagnosis, HoldoutSeries, Models, Together};
use crate::effect::Effect;
use crate::export::PortableModel;
use crate::figure::Figure;
use crate::fitted_parameter::FittedParameter;
use crate::likelihood::engine::Fit;
use crate::localise::{Residuals, localise};
use crate::nominal::structure::Structure;
use crate::residuals::score::{innovations, picture};
use crate::verdict::answer::{Refit, Status, Verdict};
use crate::verdict::odds::Odds;
use crate::workers::Workers;

/// What the report is made of.
pub(super) struct Conclusion {
    /// Every effect with a fit of its own.
    pub(super) fitted: Vec<Hypothesis>,
    /// Those of them that may be the cause.
    pub(super) singles: Vec<Hypothesis>,
    pub(super) odds: Odds,
    pub(super) verdict: Verdict,
    pub(super) augmented: Hypothesis,
    pub(super) left: f64,
    pub(super) together: Option<Together>,
    /// The nominal model of another structure that is the answer: order, delay, its runs of the judged records and the noise that it
    /// leaves in these.
    pub(super) other: Option<Other>,
}

/// A nominal model of another structure.
pub(super) struct Other {
    pub(super) structure: Structure,
    pub(super) runs: Vec<Vec<f64>>,
    pub(super) floor: (f64, f64),
}

impl Plan {
    /// The diagnosis of a conclusion; `candidates` are the effects that have a probability, `evidence` is what the records say of every one.
    pub(super) fn report(
        self,
        c: Conclusion,
        candidates: Vec<Candidate>,
        evidence: Option<Compared>,
    ) -> Diagnosis {
        let dataset = &self.dataset;
        let mut floor = self.noise_floor(&c.augmented.fit);
        let mut runs = self.simulations(&c.augmented.fit);
        if let Some(other) = &c.other {
            floor = other.floor;
            runs.iter_mut().zip(&other.runs).for_each(|(run, other)| run.after.clone_from(other));
        }
        let mut limitations = self.limitations.clone();
        let mut gap = measure(dataset, &runs, floor, (self.settings.seed, self.settings.resamples));
        let each = closures(dataset, &runs, floor, (self.settings.seed, self.settings.resamples));
        gap.per_record.iter_mut().zip(each).for_each(|(record, closure)| record.closure = closure);
        gap.identified_anew = self.identified_anew(floor);
        if self.given.is_some() && c.other.is_none() && gap.before.ci90[0] > 1.0 {
            limitations.push(
                "the model under diagnosis misses the judged records by more than their mean does: compare its units, its sample \
                 time and its coefficients with the rig's"
                    .into(),
            );
        }
        let nominal_score = self.score(&self.nominal.plain.fit);
        gap.predictive_gain =
            self.score(&c.augmented.fit).zip(nominal_score).map_or(0.0, |(after, before)| after - before);
        if dataset.criterion.simulates() {
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
            Status::None => {
                gap.closure = None;
                gap.per_record.iter_mut().for_each(|record| record.closure = None);
            }
            Status::Refit => {
                let structure = c.other.as_ref().map_or(self.structure, |other| other.structure);
                let reported = |closure| Refit { order: structure.order, delay: -structure.lead, closure };
                verdict.refit = gap.closure.map(reported);
            }
            _ => {}
        }
        let where_ = self.map(&c.augmented.fit, floor.0);
        let before = picture(dataset, &innovations(dataset, &self.nominal.plain.fit, |t| t.is_fit()));
        let after = picture(dataset, &innovations(dataset, &c.augmented.fit, |t| t.is_fit()));
        let added = self.added(&c.augmented, &candidates, c.together.as_ref());
        let next_experiment = crate::experiments::propose(dataset, &verdict, &c.singles, floor.0);
        Diagnosis {
            where_,
            verdict,
            differences: None,
            classification: None,
            gap,
            candidates,
            probability_none: c.odds.none,
            probability_unexplained: c.odds.unexplained,
            left: c.left,
            samples: dataset.fit_samples(),
            passes: dataset.passes.so_far(),
            together: c.together,
            next_experiment,
            series: self.series(&runs),
            residuals_before: before,
            residuals_after: after,
            limitations,
            evidence,
            models: Some(Models {
                nominal: self.nominal_model(),
                augmented: self.exporter.fitted(dataset, &c.augmented),
                added,
            }),
        }
    }

    /// The effects of the augmented model; parameters with the intervals that they are reported with elsewhere, where they are.
    fn added(
        &self,
        augmented: &Hypothesis,
        candidates: &[Candidate],
        together: Option<&Together>,
    ) -> Vec<(Effect, Vec<FittedParameter>)> {
        let effects = augmented.effects();
        let reported = match effects[..] {
            [only] => candidates.iter().find(|c| c.effect == only).map(|c| vec![c.parameters.clone()]),
            _ => together.filter(|pair| pair.effects == effects).map(|pair| pair.parameters.clone()),
        };
        let intervals = augmented.fit.intervals();
        let fitted = |number: usize| parameters(&self.dataset, (augmented, number), &intervals);
        let all: Vec<_> = (0..effects.len()).map(fitted).collect();
        let values =
            |all: &[Vec<FittedParameter>]| -> Vec<f64> { all.iter().flatten().map(|p| p.value).collect() };
        // A candidate on other knots has other estimates.
        let reported = reported.filter(|reported| values(reported) == values(&all));
        effects.into_iter().zip(reported.unwrap_or(all)).collect()
    }

    /// The model under diagnosis; nothing where only its predictions are known.
    fn nominal_model(&self) -> Option<PortableModel> {
        match &self.given {
            Some(given) => given.fit.as_ref().map(|fit| self.exporter.given(&self.dataset, fit)),
            None => Some(self.exporter.fitted(&self.dataset, &self.nominal.plain)),
        }
    }

    /// `G²` of the identified nominal model, where another was given.
    fn identified_anew(&self, floor: (f64, f64)) -> Option<Figure> {
        self.given.as_ref()?;
        let runs = self.simulations(&self.nominal.plain.fit);
        Some(measure(&self.dataset, &runs, floor, (self.settings.seed, self.settings.resamples)).after)
    }

    /// Where the model under diagnosis misses: as it was given, or else the identified nominal one. `noise` is the variance of the
    /// noise in the output.
    fn map(&self, augmented: &Fit, noise: f64) -> Vec<Cell> {
        let floor = self.innovation_floor(augmented);
        match &self.given {
            Some(GivenModel { residuals, is_output: true, .. }) => localise(&self.dataset, residuals, noise),
            Some(GivenModel { residuals, .. }) => localise(&self.dataset, residuals, floor),
            None => localise(&self.dataset, &Residuals::of(&self.dataset, &self.nominal.plain.fit), floor),
        }
    }

    /// The report of a pair; `gains` are those of the single effects over the nominal model, the best first.
    pub(super) fn together(&self, workers: &impl Workers, pair: &Pair, gains: &[(Effect, f64)]) -> Together {
        let (dataset, both) = (&self.dataset, &pair.hypothesis);
        let intervals = profiled(workers, dataset, both);
        let parameters =
            (0..both.effect_terms.len()).map(|number| parameters(dataset, (both, number), &intervals));
        Together::of(pair, gains, parameters.collect())
    }

    fn series(&self, runs: &[Simulated]) -> Vec<HoldoutSeries> {
        let c = &self.dataset;
        let physical = |y: &[f64]| y.iter().map(|y| c.y_mean + c.y_scale * y).collect::<Vec<f64>>();
        runs.iter()
            .map(|run| HoldoutSeries {
                record: c.scaled_records[run.number].name.clone(),
                measured: physical(&c.scaled_records[run.number].y),
                nominal: physical(&run.before),
                augmented: physical(&run.after),
            })
            .collect()
    }
}
