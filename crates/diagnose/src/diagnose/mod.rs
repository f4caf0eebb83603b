//! The diagnosis itself: the nominal model, attribution, verdict, report.

mod changed;
mod compared;
mod evidence;
mod exact;
mod given_model;
mod harm;
mod held_out;
mod judged;
mod nominal;
mod other_conditions;
mod parameters;
mod refit;
mod report;
mod ways;

use switchback_model::rig::Rig;

use self::evidence::Evidence;
use self::given_model::GivenModel;
use self::nominal::Nominal;
use self::report::Conclusion;
use self::ways::{Way, Ways};
use crate::attribution::explain::Explanation;
use crate::attribution::{PairEffort, SIGNIFICANT};
use crate::diagnosis::{Diagnosis, Status};
use crate::effect::Effect;
use crate::error::DiagnoseError;
use crate::export::Exporter;
use crate::nominal::order::{Choice, Chosen, Structure, declared, of_structure, structure};
use crate::phase::Phase;
use crate::records::campaign::Campaign;
use crate::residuals::omnibus::omnibus;
use crate::settings::{Model, Settings};
use crate::verdict::decide::{held_out_differs, parameters_are_off, unresolved, verdict, without_colour};
use crate::verdict::odds::{Leavings, holds_together, odds, odds_together};
use crate::verdict::simulators::weighed_by_closure;
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
    workers.begin(Phase::Nominal);
    let records = Campaign::new(rig)?;
    let declared = declared(rig, &model)?;
    let plan = |chosen: Chosen| Plan::new(rig, &model, settings, chosen);
    let chosen = structure(workers, records.clone(), declared, settings)?;
    let held =
        changed::plan(workers, (rig, &model), &records, settings)?.map(|plan| Way::gone(workers, plan));
    // Where parameters are all that has changed nothing is missing.
    let counts = held.as_ref().is_some_and(|way| way.tells_a_cause() && !way.does_the_same(chosen.first()));
    let (mut told, mut others) = gone(workers, chosen, &plan)?;
    if declared.is_none() {
        told = with_room_for_dynamics(workers, told, (&records, &plan))?;
    }
    match held {
        Some(held) if counts && (told.leaves_open(&held) || !held.is_outdone_by(&told)) => {
            others.push(std::mem::replace(&mut told, held))
        }
        held => others.extend(held),
    }
    Ok(Ways::new(workers, told, others).report(workers))
}

/// The way of one choice; of two, that one step ahead where it tells a cause with which no simulator is needed. Behind it the other way,
/// where that was gone, too.
fn gone(
    workers: &impl Workers,
    choice: Choice,
    plan: &impl Fn(Chosen) -> Result<Plan, DiagnoseError>,
) -> Result<(Way, Vec<Way>), DiagnoseError> {
    let (mut steps, simulator) = match choice {
        Choice::One(chosen) => return Ok((Way::gone(workers, plan(chosen)?), Vec::new())),
        Choice::Either(steps, simulator) => (plan(steps)?, simulator),
    };
    steps.pair_effort = PairEffort::WhileHopeful;
    let steps = Way::gone(workers, steps);
    let verdict = &steps.conclusion.verdict;
    let told = matches!(verdict.status, Status::Named | Status::Class);
    // No simulator sees noise that is asked for.
    let is_asked = verdict.effects.iter().any(|effect| steps.plan.settings.asked.contains(effect));
    if is_asked || told && simulator.is_needless_beside(&steps.plan.campaign, &steps.conclusion.augmented.fit)
    {
        return Ok((steps, Vec::new()));
    }
    let runs = Way::gone(workers, plan(simulator.chosen())?);
    // What a simulator leaves alone may be what it cannot see.
    Ok(match (verdict.status, runs.conclusion.verdict.status) {
        (Status::Unexplained, Status::None) => (steps, vec![runs]),
        _ => (runs, vec![steps]),
    })
}

/// The way on a nominal model with room for the machine's own dynamics, where one of those, or a delay, would be told and a higher
/// order or another delay does the same on the held-out records. What that one tells counts, unless it is such an effect again, or
/// nothing of use: then the order is the answer.
fn with_room_for_dynamics(
    workers: &impl Workers,
    first: Way,
    (records, plan): (&Campaign, &impl Fn(Chosen) -> Result<Plan, DiagnoseError>),
) -> Result<Way, DiagnoseError> {
    if !refit::tells_dynamics(&first.conclusion.verdict) {
        return Ok(first);
    }
    let simulates = first.plan.campaign.criterion.simulates();
    let wider = first.plan.structure.wider(refit::tells_a_delay(&first.conclusion.verdict));
    let fitted = workers.map(&wider, |structure| of_structure(records, *structure, simulates).ok());
    let Some(chosen) = fitted.into_iter().flatten().find(|chosen| first.does_the_same(chosen)) else {
        return Ok(first);
    };
    let again = Way::gone(workers, plan(chosen)?);
    let verdict = &again.conclusion.verdict;
    if refit::tells_dynamics(verdict) || verdict.status == Status::Unexplained {
        let conclusion = first.plan.refitted(first.conclusion, &again.plan);
        return Ok(Way { conclusion, ..first });
    }
    Ok(again)
}

/// What is told of noise whose colour is no cause.
const COLOURED: &str = "the errors of the equation are coloured, as they are wherever nobody designed the records: that belongs to the model; \
                        ask for coloured_noise to have it told as a cause";

/// What is known before any effect is tried.
#[derive(Debug)]
struct Plan {
    settings: Settings,
    campaign: Campaign,
    /// The nominal model as identified here.
    nominal: Nominal,
    /// The model under diagnosis, where it is not the identified one.
    given: Option<GivenModel>,
    /// Tracks the gap is measured on, and what the model under diagnosis makes of them.
    judged: Vec<usize>,
    runs: Vec<Vec<f64>>,
    /// That of the nominal model.
    structure: Structure,
    /// How far two effects are looked for.
    pair_effort: PairEffort,
    /// Whether the colour of the noise belongs to the model, and is no cause: of records that nobody designed.
    owns_colour: bool,
    /// Whether probabilities were calibrated on records and models like these.
    is_calibrated: bool,
    limitations: Vec<String>,
    exporter: Exporter,
}

impl Plan {
    /// Lays out what a diagnosis of the chosen nominal model starts from.
    fn new(rig: &Rig, model: &Model, settings: &Settings, chosen: Chosen) -> Result<Self, DiagnoseError> {
        let Chosen { campaign, fit, structure, told } = chosen;
        let declared = told.is_none();
        let mut settings = settings.clone();
        let mut limitations = Vec::from_iter(told);
        if campaign.criterion.simulates() {
            // What changes only the noise moves no simulation.
            settings.effects.retain(|e| !e.moves_no_simulation());
        }
        let judged = judged_tracks(&campaign, &mut limitations);
        let given = GivenModel::of(model, rig, &campaign, &judged)?;
        note_what_the_records_lack(&campaign, &mut limitations);
        let nominal = Nominal::new(&campaign, &settings, Explanation::nominal(fit));
        let runs = match &given {
            Some(given) => given.runs.clone(),
            None => nominal.runs(&campaign, &judged),
        };
        let pair_effort = if campaign.criterion.simulates() { PairEffort::Forward } else { PairEffort::Full };
        let owns_colour =
            !declared && !campaign.is_designed() && !settings.asked.iter().any(|e| e.card().colours_noise);
        let exporter = Exporter::new(rig);
        let holds_out = campaign.tracks.iter().any(|t| !t.is_fit());
        let is_calibrated = declared && holds_out && given.is_none() && !campaign.criterion.simulates();
        Ok(Self {
            settings,
            campaign,
            nominal,
            given,
            judged,
            runs,
            structure,
            pair_effort,
            owns_colour,
            is_calibrated,
            limitations,
            exporter,
        })
    }

    /// Whether the nominal model was identified from records that nobody designed, its order unknown.
    fn is_of_the_field(&self) -> bool {
        self.owns_colour && !self.campaign.holds_nominal()
    }

    /// Founds the diagnosis on another optimum of the nominal model.
    fn found_on(&mut self, nominal: Nominal) {
        if self.given.is_none() {
            self.runs = nominal.runs(&self.campaign, &self.judged);
        }
        self.nominal = nominal;
    }

    /// The nominal model on the grid of the best explanation, where that is smooth, though it seemed to follow details, and the effect
    /// gains nothing on it: the borders are curved, and the effect only rides on the knots.
    fn on_the_grid_of(&self, best: &Explanation) -> Option<Nominal> {
        if self.campaign.holds_nominal() {
            return None;
        }
        let least = self.nominal.plain.bic() - SIGNIFICANT;
        best.without_parts(&self.campaign).filter(|alone| alone.bic() < least)?;
        let smooth = best.on_a_smooth_grid(&self.campaign)?;
        let plain = smooth.without_parts(&self.campaign).filter(|alone| alone.bic() < least)?;
        let rides = smooth.bic() > plain.bic() - SIGNIFICANT;
        let detailed =
            [&plain, &self.nominal.detailed].into_iter().min_by(|x, y| x.bic().total_cmp(&y.bic()))?.clone();
        rides.then_some(Nominal { plain, detailed })
    }

    /// Ranks the candidates and draws the conclusions.
    fn attribute(&mut self, workers: &impl Workers) -> Conclusion {
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
        let samples = self.campaign.fit_samples();
        let mut left = tests.as_ref().map_or(0.0, |tests| tests.against(samples));
        // The tests of one-step predictions say nothing about simulators.
        let deviance = if self.campaign.criterion.simulates() { 0.0 } else { left };
        let refuted =
            significant && (outdone || self.hardly_closes(&best, left) || self.misses_at_places(&best));
        let leaves = Leavings { deviance, gap: self.gap_left(&best.fit), refuted };
        // What harms is no cause, and a rival all the same: what it would get goes to none of these.
        let mut odds = odds(self.nominal.plain.bic(), &rivals, leaves);
        odds.unexplained += odds.effects.drain(singles.len()..).sum::<f64>();
        let mut joint = None;
        let of_members = |of: &dyn Fn(&Explanation) -> f64| -> Vec<(Effect, f64)> {
            members.iter().map(|s| (s.parts[0].effect, of(s))).collect()
        };
        let gains = of_members(&|s| self.nominal.plain.bic() - s.bic());
        let found = pair.as_ref().map(|pair| self.together(workers, pair, &gains));
        if let Some(pair) = pair.filter(|pair| holds_together(pair, samples)) {
            let causes = pair.causes(&gains, samples);
            let together =
                odds_together(self.nominal.plain.bic(), &pair, &causes, &of_members(&Explanation::evidence));
            let (explanation, pair_left) = (pair.explanation, pair.left);
            let has_tails = causes.effects.iter().any(|e| e.card().heavy_tails);
            let misses = has_tails && self.misses_at_places(&explanation);
            let holds = self.better_held_out(&explanation, &best)
                && !self.hardly_closes(&explanation, pair_left)
                && !self.worsens(&explanation)
                && !self.harms(&explanation)
                && self.second_shows(&explanation, &causes, &all)
                && !misses
                && (!pair.is_hidden || self.shows_in_simulations(&explanation));
            if together.told() >= self.settings.name_at && holds {
                tests = omnibus(&self.campaign, &explanation.fit);
                (left, odds, joint) = (pair_left, together, Some((explanation, causes)));
                singles = members;
            }
        }
        let told = joint.as_ref().map_or(&best, |(explanation, _)| explanation);
        let odds = match self.held_out_closure(&told.fit) {
            Some(closure) if significant => weighed_by_closure(odds, closure),
            _ => odds,
        };
        let told = &joint.as_ref().map_or(&best, |(explanation, _)| explanation).parts;
        if self.owns_colour && significant && told.iter().any(|part| part.effect.card().colours_noise) {
            self.limitations.push(COLOURED.into());
        }
        let odds = match joint.is_none() && self.owns_colour {
            true => odds.with_colour_in_the_model(singles.iter().map(|s| s.parts[0].effect)),
            false => odds,
        };
        let mut ranked: Vec<(Effect, f64)> =
            singles.iter().zip(&odds.effects).map(|(s, p)| (s.parts[0].effect, *p)).collect();
        ranked.sort_by(|x, y| y.1.total_cmp(&x.1));
        let causes = joint.as_ref().map(|(_, causes)| causes);
        let mut verdict = verdict(&ranked, &odds, causes, tests.as_ref(), &self.settings);
        let explanation = joint.map_or(best, |(explanation, _)| explanation);
        if self.owns_colour {
            verdict = without_colour(verdict);
        }
        if self.only_parameters_are_off(verdict.status, &explanation.fit) {
            verdict = parameters_are_off(&verdict);
        } else if verdict.status == Status::Unexplained && self.resolves_no_gap(&explanation.fit) {
            verdict = unresolved(&odds);
        } else if verdict.status == Status::None
            && let Some(ratio) = self.held_out_errors_beyond_chance(&self.nominal.plain.fit)
        {
            verdict = held_out_differs(&odds, ratio);
        }
        verdict.calibrated = self.is_calibrated;
        let augmented = match verdict.status {
            Status::None | Status::Refit => self.nominal.plain.clone(),
            _ => explanation,
        };
        Conclusion { fitted: all, singles, odds, verdict, augmented, left, together: found, other: None }
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
            "no held-out record can be judged (there is none, it is too short, or its input never moves): gap and closure are \
             measured on the records the models were fitted to, which flatters them; hold a record out in which the input moves"
                .into(),
        );
        return numbers(true);
    }
    held_out
}

fn note_what_the_records_lack(campaign: &Campaign, limitations: &mut Vec<String>) {
    for track in campaign.tracks.iter().filter(|t| t.y.iter().all(|y| *y == t.y[0])) {
        limitations.push(format!(
            "y never moves in `{}`: its sensor may have been off; check the record, or leave it out",
            track.name
        ));
    }
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
