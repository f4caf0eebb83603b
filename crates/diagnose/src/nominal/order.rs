//! Order, lead and criterion of the nominal model: chosen from the records where no order is declared.

use switchback_model::rig::Rig;

use crate::error::DiagnoseError;
use crate::likelihood::design::Design;
use crate::likelihood::engine::{Fit, FitContext, fit};
use crate::likelihood::weights::weigh;
use crate::model::augmented::AugmentedModel;
use crate::model::stability::settles;
use crate::nominal::identified::Identified;
use crate::nominal::identify::{first_fit, identify};
use crate::nominal::knots::{first_grid, refine};
use crate::nominal::structure::{PRESENT, ROUNDS, SIMULATION, Structure};
use crate::records::dataset::{Criterion, Dataset, ScaledRecord};
use crate::records::motion::Begins;
use crate::residuals::score::innovations;
use crate::settings::{Model, Settings};
use crate::simulation::noise_response::NoiseResponse;
use crate::simulation::simulate::free_run;
use crate::workers::Workers;
use switchback_model::spectrum::{independent_share, mean_square, unpredictable_variance};

/// A structure of the nominal model with its fit.
#[derive(Debug)]
pub(crate) struct Chosen {
    /// The records with the lead and the criterion chosen.
    pub(crate) dataset: Dataset,
    pub(crate) fit: Fit,
    /// What was chosen or declared.
    pub(crate) structure: Structure,
    /// What was chosen, in words, where the rig does not declare it.
    pub(crate) reported: Option<String>,
}

/// What the fit records leave to choose from.
#[derive(Debug)]
pub(crate) enum Choice {
    /// There is one answer.
    One(Chosen),
    /// The equation error is not what the nominal model says. An effect may be the reason: then a fit one step ahead is efficient
    /// once it is added; else models are compared as simulators.
    Either(Chosen, Box<Simulator>),
}

/// The best structure identified as a simulator.
#[derive(Debug)]
pub(crate) struct Simulator {
    /// The records as they are.
    dataset: Dataset,
    structure: Structure,
    /// On the first grid.
    first: Fit,
}

/// Largest lead tried, samples.
const LEADS: isize = 2;
/// A structure this much worse than the best, as a ratio of mean squares, is as good if it is simpler.
const AS_GOOD: f64 = 1.03;
/// Below this ratio of mean squares, the one-step fit is no efficient estimate of a simulator.
const EFFICIENT: f64 = 0.8;
/// A simulation error up to this many times the variance between repeated periods is noise for the most part.
const NOISE: f64 = 2.0;
/// Share of the innovations' variance predicted by their past, from which the equation error is not white for any use.
const COLOURED: f64 = 0.1;
/// One structure tried: mean square simulation errors of the fit one step ahead and of the fit as a simulator.
struct Tried {
    structure: Structure,
    one_step: f64,
    simulator: Option<Fit>,
}

impl Tried {
    fn simulated(&self) -> f64 {
        self.simulator.as_ref().map_or(f64::INFINITY, |f| f.power)
    }
}

/// The order that a given model has or the rig declares.
///
/// # Errors
/// [`DiagnoseError::Order`] where they differ.
pub(crate) fn declared(rig: &Rig, model: &Model) -> Result<Option<usize>, DiagnoseError> {
    match (model, rig.order) {
        (Model::Given(m), Some(n)) if m.a.len() != n => {
            Err(DiagnoseError::Order { model: m.a.len(), rig: n })
        }
        (Model::Given(m), _) => Ok(Some(m.a.len())),
        (_, order) => Ok(order),
    }
}

/// The structure of the nominal model: of the order declared, else chosen.
pub(crate) fn structure(
    workers: &impl Workers,
    (rig, dataset): (&Rig, Dataset),
    declared: Option<usize>,
    settings: &Settings,
) -> Result<Choice, DiagnoseError> {
    match declared {
        Some(n) => {
            let dataset = dataset.counted_for(n);
            let fit = identify(&dataset, n.max(1))?;
            let structure = Structure::of_order(n);
            Ok(Choice::One(Chosen { dataset, fit, structure, reported: None }))
        }
        None => choose(workers, (rig, &dataset), settings),
    }
}

/// Chooses among orders up to the highest of the settings and leads of up to [`LEADS`] samples by the simulation error on the fit records.
///
/// One-step criteria prefer high orders on real records, whose noise is never white, and put into `A` what they know of the
/// noise. Where a fit of the free run itself simulates the records much better, the equation error is not what the model
/// says.
///
/// From a start one step ahead, white noise in the output keeps a simulator from its optimum: the structure that the identifier chooses starts from
/// its model, too.
fn choose(
    workers: &impl Workers,
    (rig, dataset): (&Rig, &Dataset),
    settings: &Settings,
) -> Result<Choice, DiagnoseError> {
    let attempts = workers.map(&structures(dataset, settings), |s| attempt(dataset, *s));
    let mut tried = Vec::new();
    let mut failure = None;
    for attempt in attempts {
        match attempt {
            Ok(found) => tried.push(found),
            Err(e) => failure = failure.or(Some(e)),
        }
    }
    if tried.is_empty() {
        return Err(failure.unwrap_or_else(unstable));
    }
    let is_allowed = |found: &Identified| found.structure.order <= settings.max_order;
    if let Some(identified) = Identified::of(rig).filter(is_allowed) {
        add(&mut tried, identified.structure, identified.simulator(dataset));
    }
    let steps =
        simplest(&tried, |t| t.one_step).map(|found| one_step(dataset, found.structure)).transpose()?;
    let runs = simplest(&tried, Tried::simulated).and_then(|t| {
        let first = t.simulator.clone()?;
        Some(Simulator { dataset: dataset.clone(), structure: t.structure, first })
    });
    match (steps, runs) {
        (Some(steps), Some(runs)) if !runs.is_needless_beside(&steps.dataset, &steps.fit) => {
            Ok(Choice::Either(steps, Box::new(runs)))
        }
        (Some(steps), _) => Ok(Choice::One(steps)),
        (None, Some(runs)) => Ok(Choice::One(runs.chosen())),
        (None, None) => Err(unstable()),
    }
}

/// The nominal model of a structure that was not chosen, identified one step ahead or as a simulator.
///
/// # Errors
/// [`DiagnoseError`] where no such model fits the records.
pub(crate) fn of_structure(
    dataset: &Dataset,
    structure: Structure,
    simulates: bool,
) -> Result<Chosen, DiagnoseError> {
    if !simulates {
        return one_step(dataset, structure);
    }
    let first = attempt(dataset, structure)?.simulator.ok_or_else(unstable)?;
    Ok(Simulator { dataset: dataset.clone(), structure, first }.chosen())
}

/// The structure identified one step ahead.
fn one_step(dataset: &Dataset, structure: Structure) -> Result<Chosen, DiagnoseError> {
    let dataset = structure.applied(dataset);
    let fit = identify(&dataset, structure.order)?;
    let reported = Some(format!("{} was chosen from the fit records", structure.reported()));
    Ok(Chosen { dataset, fit, structure, reported })
}

impl Simulator {
    /// The structure with its borders' knots placed, compared as a simulator from here on.
    pub(crate) fn chosen(&self) -> Chosen {
        let led = self.structure.applied(&self.dataset);
        let share = independent_share(&innovations(&led.judged_by(SIMULATION), &self.first, |t| t.is_fit()));
        let dataset = led.judged_by(Criterion::Simulation { share });
        let mut fit = self.first.clone();
        fit.deviance *= share;
        let fit = refine(&dataset, fit, &|_| AugmentedModel::default());
        let reported = format!(
            "{} was chosen from the fit records; the equation error is far from white, so models are fitted and compared by \
             their free run",
            self.structure.reported()
        );
        Chosen { dataset, fit, structure: self.structure, reported: Some(reported) }
    }

    /// Whether a fit one step ahead is all that the records ask for: what it misses in simulation is noise, or it is as
    /// good as the simulator's fit and its innovations are white.
    pub(crate) fn is_needless_beside(&self, dataset: &Dataset, fit: &Fit) -> bool {
        if !settles(&fit.linear.a) {
            return false;
        }
        let error = simulation_error(dataset, fit);
        let repeats = NoiseResponse::of(fit).repeat_variance(dataset, ScaledRecord::is_fit);
        let noise = repeats.map_or(0.0, |(variance, _)| variance);
        let colour = 1.0 - white_share(fit);
        error < NOISE * noise || (colour < COLOURED && self.first.power > EFFICIENT * error)
    }
}

/// Share of the innovations' variance that their past does not predict, each weighed as it was for the fit: what is hit by an
/// outlier shows nothing about the colour of the rest.
fn white_share(fit: &Fit) -> f64 {
    let (design, noise) = (&fit.design(), &fit.augmented.noise);
    let raw = design.innovations(&fit.linear, &design.whitener(noise, &fit.linear.a));
    let weights = weigh(design, noise, &fit.linear, &raw);
    let weighed = weights.by_scaled(&raw);
    unpredictable_variance(&weighed) / mean_square(&weighed).max(1e-300)
}

fn unstable() -> DiagnoseError {
    DiagnoseError::Singular { reason: "every order tried gives an unstable model".into() }
}

/// Every structure, simpler ones first.
fn structures(dataset: &Dataset, settings: &Settings) -> Vec<Structure> {
    // Without a threshold a reversal is confirmed by the first move; in real time it is known no sooner.
    let begins: &[Begins] = match dataset.rule.threshold > 0.0 && !settings.causal {
        true => &[Begins::Confirmed, Begins::AtExtreme],
        false => &[Begins::Confirmed],
    };
    let mut all = Vec::new();
    let leads = if settings.causal { PRESENT } else { LEADS };
    for lead in 0..=leads {
        for order in 1..=settings.max_order.max(1) {
            all.extend(begins.iter().map(|&begins| Structure { order, lead, begins }));
        }
    }
    all
}

/// A simulator beside those tried, or in the place of a worse one of its order and lead.
fn add(tried: &mut Vec<Tried>, structure: Structure, simulator: Option<Fit>) {
    let found = Tried { structure, one_step: f64::INFINITY, simulator };
    let alike = |t: &Tried| (t.structure.order, t.structure.lead) == (structure.order, structure.lead);
    match tried.iter().position(alike) {
        Some(at) if found.simulated() < tried[at].simulated() => tried[at].simulator = found.simulator,
        Some(_) => {}
        None => tried.push(found),
    }
}

/// The first structure that is as good as the best; nothing where none is any good.
fn simplest(tried: &[Tried], error: impl Fn(&Tried) -> f64) -> Option<&Tried> {
    let least = tried.iter().map(&error).fold(f64::INFINITY, f64::min);
    tried.iter().find(|t| least.is_finite() && error(t) <= AS_GOOD * least)
}

/// Fits one structure on the first grid, one step ahead and as a simulator.
fn attempt(dataset: &Dataset, structure: Structure) -> Result<Tried, DiagnoseError> {
    let led = &structure.applied(dataset);
    let one_step = first_fit(led, structure.order)?;
    let simulates = led.judged_by(SIMULATION);
    let grid = first_grid(led);
    let mut start = one_step.linear.clone();
    // Poles pulled in until the model forgets.
    while !settles(&start.a) {
        start.a.iter_mut().enumerate().for_each(|(i, a)| *a *= 0.99_f64.powi(i as i32 + 1));
    }
    let context = FitContext { dataset: &simulates, grid: &grid, known: None };
    let simulator = fit(context, &|_| AugmentedModel::default(), &[], &start, ROUNDS);
    // There are many structures: none is held.
    let nothing = Design::of_nothing(&simulates).into();
    let simulator = simulator.map(|fit| fit.set_aside(&nothing));
    let error = if settles(&one_step.linear.a) { simulation_error(led, &one_step) } else { f64::INFINITY };
    Ok(Tried { structure, one_step: error, simulator })
}

/// Mean square simulation error over the counted samples of the fit records.
fn simulation_error(dataset: &Dataset, fit: &Fit) -> f64 {
    let mut sum = 0.0;
    for (number, scaled) in dataset.scaled_records.iter().enumerate().filter(|(_, t)| t.is_fit()) {
        let y = free_run(dataset, fit, number, scaled);
        sum += y.iter().zip(&scaled.y).map(|(x, y)| (x - y).powi(2)).sum::<f64>();
    }
    sum / dataset.fit_samples().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{noise_free, small_dataset, small_model, white};

    /// The share of white innovations where the errors of the equation are coloured by `ar`, or hit here and there.
    fn share(ar: f64, is_hit: bool) -> f64 {
        let (dataset, grid) = small_dataset();
        let truth = small_model(&grid);
        let mut dataset = noise_free(dataset, &grid, &AugmentedModel::default(), &truth);
        let (mut noise, mut error) = (white(), 0.0);
        let mut past = [0.0; 2];
        for (t, y) in dataset.scaled_records[0].y.iter_mut().enumerate() {
            error = ar * error + 0.01 * noise();
            let hit = if is_hit && t % 37 < 2 { 1.0 } else { 0.0 };
            let now = error + hit - truth.a[0] * past[0] - truth.a[1] * past[1];
            past = [now, past[0]];
            *y += now;
        }
        let mut augmented = AugmentedModel::default();
        augmented.noise.mixture = is_hit.then_some((0.05, 50.0));
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        white_share(&fit(context, &|_| augmented.clone(), &[], &truth, 20).expect("a fit"))
    }

    #[test]
    fn in_real_time_no_structure_looks_ahead() {
        let (mut dataset, _) = small_dataset();
        dataset.rule.threshold = 0.01;
        let of = |causal| structures(&dataset, &Settings { causal, ..Settings::default() });
        let looks_ahead = |s: &Structure| s.lead > 1 || s.begins == Begins::AtExtreme;
        assert!(of(false).iter().any(looks_ahead));
        assert!(!of(true).is_empty() && !of(true).iter().any(looks_ahead));
    }

    #[test]
    fn what_the_past_foretells_is_colour_and_what_hits_is_none() {
        let [plain, coloured, hit] = [share(0.0, false), share(0.9, false), share(0.0, true)];
        assert!(plain > 0.85 && hit > 0.85, "{plain} {hit}");
        assert!(coloured < 0.6 * plain, "{coloured} {plain}");
    }
}
