//! The diagnosis itself: the nominal model, attribution, verdict, report.

use switchback_estimator::rig::Rig;

use crate::attribution::{Attribution, detail};
use crate::campaign::{Campaign, Criterion};
use crate::closure::{Simulated, measure};
use crate::decide::{Leavings, Odds, SIGNIFICANT, holds_together, odds, odds_together, verdict};
use crate::diagnosis::{Candidate, Diagnosis, FittedParameter, Gap, HoldoutSeries, Status, Together};
use crate::effect::Effect;
use crate::engine::Fit;
use crate::error::DiagnoseError;
use crate::explain::Explanation;
use crate::localise::localise;
use crate::nominal::identify;
use crate::omnibus::{Omnibus, omnibus};
use crate::order::choose;
use crate::repeats::Repeating;
use crate::score::{heldout_log_score, innovations, picture};
use crate::settings::{Model, Settings};
use crate::simulate::{free_run, noise_gain, repeat_variance};
use crate::simulators::weighed_by_closure;
use crate::spectrum::{mean_square, unpredictable_variance};
use crate::workers::{Serial, Workers};

/// Diagnoses the gap between a model and a rig.
///
/// Identifies (or takes) the nominal model, fits every effect of the library together with it, ranks them by penalised
/// likelihood, tests what the best leaves, and measures how far it closes the gap on the held-out records.
///
/// # Errors
/// [`DiagnoseError`] where nothing can be judged; what can be judged only in part becomes a
/// [limitation](Diagnosis::limitations).
pub fn diagnose(rig: &Rig, model: Model, settings: &Settings) -> Result<Diagnosis, DiagnoseError> {
    diagnose_with(&Serial, rig, model, settings)
}

/// [`diagnose`], its independent pieces of work given to `workers`; the answer does not depend on them.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_with(
    workers: &impl Workers,
    rig: &Rig,
    model: Model,
    settings: &Settings,
) -> Result<Diagnosis, DiagnoseError> {
    Ok(Plan::new(workers, rig, model, settings)?.conclude(workers))
}

/// What is known before any effect is tried.
#[derive(Debug)]
struct Plan {
    settings: Settings,
    campaign: Campaign,
    /// The nominal model as identified here.
    nominal: Explanation,
    /// The same with border knots placed from the data.
    detailed: Explanation,
    nominal_innovations: Vec<Vec<f64>>,
    /// Simulated outputs of the model under diagnosis, one a judged track, where it is not the identified one.
    foreign: Option<Vec<Vec<f64>>>,
    /// Tracks the gap is measured on.
    judged: Vec<usize>,
    limitations: Vec<String>,
}

impl Plan {
    /// Identifies the nominal model.
    fn new(
        workers: &impl Workers,
        rig: &Rig,
        model: Model,
        settings: &Settings,
    ) -> Result<Self, DiagnoseError> {
        let mut campaign = Campaign::new(rig)?;
        let mut settings = settings.clone();
        let mut limitations = Vec::new();
        let order = match (&model, rig.order) {
            (Model::Given(m), Some(n)) if m.a.len() != n => {
                return Err(DiagnoseError::Order { model: m.a.len(), rig: n });
            }
            (Model::Given(m), _) => Some(m.a.len()),
            (_, order) => order,
        };
        let nominal = match order {
            Some(n) => identify(&campaign, n.max(1))?,
            None => {
                let chosen = choose(workers, &campaign, settings.max_order)?;
                limitations.push(chosen.told());
                campaign = chosen.campaign;
                chosen.fit
            }
        };
        if campaign.criterion.simulates() {
            // What changes only the noise moves no simulation.
            settings.effects.retain(|e| !e.is_noise() && *e != Effect::SensorQuantisation);
        }
        let judged = judged_tracks(&campaign, &mut limitations);
        let foreign = match &model {
            Model::Identify => None,
            Model::Given(m) => {
                let given = crate::given::scaled(&campaign, m)?;
                Some(judged.iter().map(|&k| free_run(&campaign, &given, k, &campaign.tracks[k])).collect())
            }
            Model::Predicted => Some(predictions(rig, &campaign, &judged)?),
        };
        note_what_the_records_lack(&campaign, &mut limitations);
        let detailed = Explanation::nominal(nominal);
        let nominal = coarse(&campaign, &detailed);
        let nominal_innovations = innovations(&campaign, &nominal.fit, |t| t.is_fit());
        Ok(Self { settings, campaign, nominal, detailed, nominal_innovations, foreign, judged, limitations })
    }

    /// Ranks the candidates and draws the conclusions.
    fn conclude(self, workers: &impl Workers) -> Diagnosis {
        let attribution = Attribution {
            campaign: &self.campaign,
            settings: &self.settings,
            nominal: &self.nominal,
            detailed: &self.detailed,
            workers,
        };
        let mut singles = attribution.singles();
        self.hear_the_held_out(&mut singles);
        let significant = singles.first().is_some_and(|s| s.bic() < self.nominal.bic() - 0.5 * SIGNIFICANT);
        if significant {
            self.drop_noise_where_the_gap_is_systematic(&mut singles);
            self.drop_what_held_out_records_refute(&mut singles);
        }
        let best = singles.first().filter(|_| significant).unwrap_or(&self.nominal).clone();
        let mut tests = omnibus(&self.campaign, &best.fit);
        let mut left = tests.as_ref().map_or(0.0, Omnibus::excess);
        let effects: Vec<(Effect, f64)> = singles.iter().map(|s| (s.parts[0].effect, s.evidence())).collect();
        let leaves = Leavings { deviance: left, gap: self.gap_left(&best.fit) };
        let mut odds = odds(self.nominal.bic(), &effects, leaves);
        let mut joint = None;
        let more = tests.as_ref().filter(|_| significant && self.settings.max_effects > 1);
        let pair = more.and_then(|tests| attribution.pair(&singles, tests));
        let found = pair.as_ref().map(Together::of);
        if let Some(pair) = pair.filter(|pair| holds_together(pair, self.campaign.fit_samples())) {
            let together = odds_together(self.nominal.bic(), &pair, &effects);
            let explanation = pair.explanation;
            if together.most() >= self.settings.name_at && self.better_held_out(&explanation, &best) {
                tests = omnibus(&self.campaign, &explanation.fit);
                (left, odds, joint) = (pair.left, together, Some(explanation));
            }
        }
        let odds = match self.held_out_closure(&best.fit) {
            Some(closure) if significant => weighed_by_closure(odds, closure),
            _ => odds,
        };
        let mut ranked: Vec<(Effect, f64)> =
            singles.iter().zip(&odds.effects).map(|(s, p)| (s.parts[0].effect, *p)).collect();
        ranked.sort_by(|x, y| y.1.total_cmp(&x.1));
        let verdict = verdict(&ranked, &odds, joint.as_ref(), tests.as_ref(), &self.settings);
        let augmented = match verdict.status {
            Status::None => self.nominal.clone(),
            _ => joint.clone().unwrap_or(best),
        };
        self.report(Conclusion { singles, odds, verdict, augmented, left, together: found })
    }

    /// The held-out records have their say: what an explanation loses on them in log score counts like a loss in
    /// deviance. Slow changes may be followed where they were fitted and still lead nowhere beyond.
    fn hear_the_held_out(&self, singles: &mut [Explanation]) {
        let Some(nominal) = self.score(&self.nominal.fit) else { return };
        let held_out = self.campaign.tracks.iter().filter(|t| !t.is_fit());
        let samples = held_out.map(|t| t.v.len().saturating_sub(t.from)).sum::<usize>() as f64;
        // Simulators are no safer for beating the nominal model: what they lose to the best of them counts.
        let reference = match self.campaign.criterion {
            Criterion::OneStep => nominal,
            Criterion::Simulation { .. } => {
                singles.iter().filter_map(|s| self.score(&s.fit)).fold(nominal, f64::max)
            }
        };
        let nominal_error = self.simulation_error(&self.nominal.fit);
        for single in singles.iter_mut() {
            let lost = self.score(&single.fit).map_or(0.0, |s| reference - s);
            let excused = single.parts.iter().any(|p| p.effect.is_of_its_record());
            single.held_out = if excused { 0.0 } else { 2.0 * samples * lost.max(0.0) };
            if self.simulation_error(&single.fit) > RUNAWAY * nominal_error {
                // What runs away on other records is no account of these either.
                single.held_out += (self.nominal.bic() - single.bic()).max(0.0);
            }
        }
        singles.sort_by(|x, y| x.evidence().total_cmp(&y.evidence()));
    }

    /// Whether one explanation predicts the held-out records better than another; true without any, and for effects of
    /// their own record, which need not hold in others.
    fn better_held_out(&self, one: &Explanation, than: &Explanation) -> bool {
        let excused = one.effects().iter().any(|e| e.is_of_its_record());
        let runs_away = self.simulation_error(&one.fit) > RUNAWAY * self.simulation_error(&than.fit);
        !runs_away
            && (excused
                || self.score(&one.fit).zip(self.score(&than.fit)).is_none_or(|(one, other)| one > other))
    }

    /// Noise moves no simulation error: where much of the error repeats with the input under the best noise explanation, or
    /// an effect that does move it takes much of it away on the held-out records, the noise is no cause of it, however
    /// well it predicts one step ahead.
    fn drop_noise_where_the_gap_is_systematic(&self, singles: &mut Vec<Explanation>) {
        let Some(best) = singles.first().filter(|s| s.parts[0].effect.is_noise()) else { return };
        let mut repeating = Repeating::default();
        for (number, track) in self.campaign.tracks.iter().enumerate() {
            let run = free_run(&self.campaign, &best.fit, number, track);
            let error: Vec<f64> = track.y.iter().zip(&run).map(|(y, run)| y - run).collect();
            repeating.add(track, &error);
        }
        let error = |s: &Explanation| self.simulation_error(&s.fit);
        let gained = self.nominal.evidence() - best.evidence();
        let rivals = singles.iter().filter(|s| {
            let effect = s.parts[0].effect;
            let serious = self.nominal.evidence() - s.evidence() > SERIOUS * gained;
            serious && !effect.is_noise() && !effect.is_of_its_record()
        });
        let least = rivals.map(error).fold(f64::INFINITY, f64::min);
        let repeats = repeating.share().is_some_and(|share| share > REPEATS);
        if repeats || least < SYSTEMATIC * error(best) {
            singles.retain(|s| !s.parts[0].effect.is_noise());
        }
    }

    /// A simulator that is worse on held-out records explains nothing, however well it follows those it was fitted to.
    fn drop_what_held_out_records_refute(&self, singles: &mut Vec<Explanation>) {
        if self.campaign.criterion.simulates() {
            singles.retain(|s| self.held_out_closure(&s.fit).is_none_or(|closure| closure > 0.0));
        }
    }

    /// Share of the gap that a model closes on the judged records, where models are compared as simulators and there is a
    /// gap.
    fn held_out_closure(&self, fit: &Fit) -> Option<f64> {
        let simulates = self.campaign.criterion.simulates();
        simulates.then(|| self.gap_left(fit)).flatten().map(|left| 1.0 - left)
    }

    /// Share of the gap on the judged records that a model leaves, where there is a gap.
    fn gap_left(&self, fit: &Fit) -> Option<f64> {
        let gap =
            measure(&self.campaign, &self.simulations(fit), self.noise_floor(fit), (self.settings.seed, 0));
        (gap.before.estimate > 0.0).then(|| gap.after.estimate / gap.before.estimate)
    }

    /// Log score a sample on the held-out records: of one-step predictions, or of the simulation.
    fn score(&self, fit: &Fit) -> Option<f64> {
        match self.campaign.criterion {
            Criterion::OneStep => heldout_log_score(&self.campaign, fit),
            Criterion::Simulation { share } => {
                Some(-0.5 * share * mean_square(&self.judged_errors(fit)).max(1e-300).ln())
            }
        }
    }

    /// Squared error of the free-run simulation, summed over the judged records.
    fn simulation_error(&self, fit: &Fit) -> f64 {
        let error = |&number: &usize| {
            let track = &self.campaign.tracks[number];
            let run = free_run(&self.campaign, fit, number, track);
            track.y.iter().zip(&run).skip(track.from).map(|(y, run)| (y - run).powi(2)).sum::<f64>()
        };
        self.judged.iter().map(error).sum()
    }

    fn report(self, c: Conclusion) -> Diagnosis {
        let campaign = &self.campaign;
        let floor = self.noise_floor(&c.augmented.fit);
        let runs = self.simulations(&c.augmented.fit);
        let mut limitations = self.limitations.clone();
        let mut gap = measure(campaign, &runs, floor, (self.settings.seed, self.settings.resamples));
        let nominal_score = self.score(&self.nominal.fit);
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
        if matches!(c.verdict.status, Status::None) {
            gap.closure = None;
        }
        let candidates = c
            .singles
            .iter()
            .zip(&c.odds.effects)
            .map(|(s, p)| self.candidate(s, *p, floor, nominal_score))
            .collect::<Vec<_>>();
        let mut candidates = candidates;
        candidates.sort_by(|x, y| y.probability.total_cmp(&x.probability).then(x.bic.total_cmp(&y.bic)));
        let variance = self.innovation_floor(&c.augmented.fit);
        let before = picture(campaign, &self.nominal_innovations);
        let after = picture(campaign, &innovations(campaign, &c.augmented.fit, |t| t.is_fit()));
        let next_experiment = crate::experiments::propose(campaign, &c.verdict, &c.singles, floor.0);
        Diagnosis {
            where_: localise(campaign, &self.nominal.fit, variance),
            verdict: c.verdict,
            gap,
            candidates,
            probability_none: c.odds.none,
            probability_unexplained: c.odds.unexplained,
            left: c.left,
            samples: campaign.fit_samples(),
            together: c.together,
            next_experiment,
            series: self.series(&runs),
            residuals_before: before,
            residuals_after: after,
            limitations,
        }
    }

    /// Variance of the noise in the output and its relative standard error.
    ///
    /// Repetition within periodic records needs no model; the augmented model's own floor is the other estimate. Effects
    /// that do not repeat with the input inflate the first, effects left out the second: the smaller one holds.
    fn noise_floor(&self, fit: &Fit) -> (f64, f64) {
        if self.campaign.criterion.simulates() {
            return self.unforeseeable(fit);
        }
        let model = fit.power * noise_gain(fit);
        let relative = |n: f64| (2.0 / n).sqrt() * 2.0;
        match repeat_variance(&self.campaign, |_| true) {
            Some((repeat, count)) if repeat < model => (repeat, relative(count as f64)),
            _ => (model, relative(fit.samples as f64)),
        }
    }

    /// The part of the simulation error on the judged records that its own past does not foretell: noise in the output is
    /// at most that.
    fn unforeseeable(&self, fit: &Fit) -> (f64, f64) {
        let errors = self.judged_errors(fit);
        let count: usize = errors.iter().map(Vec::len).sum();
        (unpredictable_variance(&errors), (2.0 / count.max(1) as f64).sqrt() * 2.0)
    }

    /// Errors of the free run on the judged records.
    fn judged_errors(&self, fit: &Fit) -> Vec<Vec<f64>> {
        self.judged
            .iter()
            .map(|&number| {
                let track = &self.campaign.tracks[number];
                let run = free_run(&self.campaign, fit, number, track);
                run.iter().zip(&track.y).skip(track.from).map(|(x, y)| y - x).collect()
            })
            .collect()
    }

    /// Variance of the innovations without the gap.
    fn innovation_floor(&self, fit: &Fit) -> f64 {
        let power = match self.campaign.criterion {
            Criterion::OneStep => fit.power,
            Criterion::Simulation { .. } => self.unforeseeable(fit).0,
        };
        power.min(self.nominal.fit.power).max(1e-300)
    }

    fn simulations(&self, fit: &Fit) -> Vec<Simulated> {
        self.judged
            .iter()
            .enumerate()
            .map(|(i, &number)| {
                let track = &self.campaign.tracks[number];
                let before = match &self.foreign {
                    Some(runs) => runs[i].clone(),
                    None => free_run(&self.campaign, &self.nominal.fit, number, track),
                };
                Simulated { number, before, after: free_run(&self.campaign, fit, number, track) }
            })
            .collect()
    }

    fn candidate(&self, s: &Explanation, p: f64, floor: (f64, f64), nominal: Option<f64>) -> Candidate {
        let effect = s.parts[0].effect;
        let runs = self.simulations(&s.fit);
        let Gap { before, closure, after, .. } =
            measure(&self.campaign, &runs, floor, (self.settings.seed, 0));
        let closure = closure.map(|_| 1.0 - after.estimate / before.estimate);
        Candidate {
            effect,
            stage: effect.stage(),
            probability: p,
            parameters: s
                .fit
                .own
                .iter()
                .zip(&s.fit.own_se)
                .map(|(o, se)| FittedParameter { name: o.name, unit: o.unit, value: o.value, se: *se })
                .collect(),
            bic: s.bic() - self.nominal.bic(),
            heldout_log_score: self.score(&s.fit).zip(nominal).map_or(0.0, |(a, b)| a - b),
            closure,
        }
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

/// What the report is made of.
struct Conclusion {
    singles: Vec<Explanation>,
    odds: Odds,
    verdict: crate::diagnosis::Verdict,
    augmented: Explanation,
    left: f64,
    together: Option<Together>,
}

/// Simulation error on held-out records, over that of the model without the effect, from which a fit has run away.
const RUNAWAY: f64 = 20.0;
/// Share of the simulation error that may repeat with the input under an explanation by noise.
const REPEATS: f64 = 0.12;
/// Share of the simulation error that another effect must leave for noise to remain a cause, and of the noise's gain that
/// it must gain to be heard.
const SYSTEMATIC: f64 = 0.88;
const SERIOUS: f64 = 0.2;
/// The model without the knots that follow details, where these matter; else the model itself.
fn coarse(campaign: &Campaign, detailed: &Explanation) -> Explanation {
    match detailed.on_an_even_grid(campaign) {
        Some(even) if even.bic() - detailed.bic() > detail(campaign) => even,
        _ => detailed.clone(),
    }
}

/// The hold-out records; without any, the fit records, with a word about it.
fn judged_tracks(campaign: &Campaign, limitations: &mut Vec<String>) -> Vec<usize> {
    let numbers = |fit: bool| {
        campaign
            .tracks
            .iter()
            .enumerate()
            .filter(|(_, t)| t.is_fit() == fit && t.from + 20 < t.v.len())
            .map(|(i, _)| i)
            .collect::<Vec<usize>>()
    };
    let held_out = numbers(false);
    if held_out.is_empty() {
        limitations.push(
            "no record with use = \"holdout\" is long enough: gap and closure are measured on the records the models were \
             fitted to, which flatters them; hold a record out"
                .into(),
        );
        return numbers(true);
    }
    held_out
}

/// The `y_sim` of the judged records, dimensionless.
fn predictions(rig: &Rig, campaign: &Campaign, judged: &[usize]) -> Result<Vec<Vec<f64>>, DiagnoseError> {
    judged
        .iter()
        .map(|&k| {
            let r = &rig.records[k];
            let found = r.predicted.as_deref().unwrap_or_default();
            if found.len() != r.record.len() {
                return Err(DiagnoseError::Prediction {
                    record: r.name.clone(),
                    found: found.len(),
                    expected: r.record.len(),
                });
            }
            if let Some((index, &value)) = found.iter().enumerate().find(|(_, x)| !x.is_finite()) {
                return Err(DiagnoseError::PredictionNotFinite { record: r.name.clone(), index, value });
            }
            Ok(found.iter().map(|y| (y - campaign.y_mean) / campaign.y_scale).collect())
        })
        .collect()
}

fn note_what_the_records_lack(campaign: &Campaign, limitations: &mut Vec<String>) {
    if campaign.fit().all(|t| t.is_pulsed()) {
        limitations.push(
            "no free record among the fit records: pulse experiments cannot see backlash or gradual transition, and hardly \
             rate dependence; add a free record with reversals of many sizes"
                .into(),
        );
    }
    if campaign.tracks.iter().all(|t| t.period.is_none()) {
        limitations.push(
            "no record repeats its input three times: noise is told from the systematic part by the model's floor alone"
                .into(),
        );
    }
    if campaign.rule.threshold > 0.0 {
        limitations.push(format!(
            "noise on v fakes reversals: moves below {:.3e} input units against the branch were not counted as such",
            campaign.rule.threshold * campaign.v_width
        ));
    }
}
