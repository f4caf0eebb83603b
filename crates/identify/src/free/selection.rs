//! Order, delay and number of knots, chosen by cross-validation on the fit records.

use super::cross_validation::{Assessed, FOLDS, assess_all, assess_next};
use super::data::Data;
use super::error::FreeError;
use super::fit::{FIRST_KNOTS, Ladder};
use super::problem::{Segment, Structure};
use super::progress::Progress;
use super::settings::{InputMap, Settings};
use super::simulation_error::Effort;
use super::simulation_error::cost;
use std::ops::RangeInclusive;

/// Orders tried.
const ORDERS: RangeInclusive<usize> = 1..=4;
/// Delays tried. −1: no delay at all; −2: `y` answers one sample before `v` shows, as when the sensor of `v` lags.
const DELAYS: RangeInclusive<isize> = -2..=1;
/// Knots a curve tried in the second stage; the first stage has [`FIRST_KNOTS`].
const KNOTS: [usize; 6] = [3, 4, 5, 7, 10, 15];

/// One candidate and what cross-validation says of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Candidate {
    /// Order and delay.
    pub structure: Structure,
    /// Knots of each curve; 2 for a straight line.
    pub knots: usize,
    /// Free parameters.
    pub parameters: usize,
    /// `100·(1 − √(Σ(y−ŷ)²/Σ(y−ȳ)²))`, free runs over blocks that the fit had not seen; the criterion.
    pub fit_percent: f64,
    /// How far its squared error exceeds the best candidate's, in standard errors of the difference over folds.
    pub behind: f64,
}

/// How the structure was chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Every candidate tried, best first; empty where the settings left nothing to choose.
    pub(crate) candidates: Vec<Candidate>,
    /// Blocks of time that were left out in turn.
    pub folds: usize,
    /// Order and delay chosen.
    pub structure: Structure,
    /// Knots of each curve chosen.
    pub knots: usize,
}

/// Chooses what the settings leave open.
///
/// First every order and delay at a middling number of knots, then every number of knots at the best
/// order of each delay. The criterion is the free run over blocks of time left out of the fit, each started from its own first outputs. Of
/// all candidates within one standard error of the best, the one with fewest parameters is taken (the one-standard-error rule of
/// L. Breiman et al., "Classification and Regression Trees", 1984, §3.4.3): neighbours differ by less than chance, and the
/// smaller ones travel better to records that the fit has not seen.
pub(super) fn select(
    data: &Data,
    settings: &Settings,
    progress: &dyn Progress,
) -> Result<Selection, FreeError> {
    let orders: Vec<usize> = settings.order.map_or(ORDERS.collect(), |n| vec![n]);
    let delays: Vec<isize> =
        settings.delay.map_or(DELAYS.filter(|&d| settings.allows(d)).collect(), |d| vec![d]);
    let knots: Vec<usize> = match (settings.input_map, settings.knots) {
        (InputMap::Linear, _) => vec![2],
        (_, Some(k)) => vec![k],
        _ => KNOTS.to_vec(),
    };
    let first_knots = if knots.len() == 1 { knots[0] } else { FIRST_KNOTS };
    // Smaller structures first: by falling delay, then by order.
    let structures: Vec<Structure> = delays
        .iter()
        .rev()
        .flat_map(|&delay| orders.iter().map(move |&order| Structure { order, delay }))
        .collect();
    if let ([structure], [knots]) = (&structures[..], &knots[..]) {
        return Ok(Selection { candidates: Vec::new(), folds: 0, structure: *structure, knots: *knots });
    }
    let ladder = Ladder::new(data, settings.input_map, first_knots);
    let more_knots = knots.iter().filter(|&&k| k != first_knots).count();
    progress.found(FOLDS + more_knots);
    let mut assessed = assess_all(&ladder, &structures, settings.refine, progress);
    assessed.sort_by(|x, y| y.fit_percent.total_cmp(&x.fit_percent));
    let mut second: Vec<Assessed> = Vec::new();
    for &k in knots.iter().filter(|&&k| k != first_knots) {
        let ladder = Ladder::last_step(data, settings.input_map, k);
        second.extend(best_of_each_delay(&assessed).map(|a| assess_next(&ladder, a, settings.refine)));
        progress.did_one();
    }
    assessed.extend(second);
    assessed.sort_by(|x, y| y.fit_percent.total_cmp(&x.fit_percent));
    let candidates: Vec<Candidate> = assessed.iter().map(|a| candidate(a, &assessed[0])).collect();
    let close = candidates.iter().filter(|c| c.behind <= 1.0);
    match close.min_by_key(|c| c.parameters) {
        Some(&Candidate { structure, knots, .. }) => {
            Ok(Selection { candidates, folds: FOLDS, structure, knots })
        }
        None => {
            // Without a fold's share of the data the smallest structure must still have its two samples a parameter.
            let smallest = structures[0];
            let mut blocks = ladder.top().blocks(smallest, FOLDS);
            blocks.pop();
            ladder.top().basis.check_length(smallest, &blocks)?;
            Err(FreeError::Unstable { order: smallest.order })
        }
    }
}

/// The data with the reversal rule that fits best.
///
/// The rules have the same parameters, so the fit itself decides; a middling structure shows the difference. All are judged
/// over the same samples but for a few at the very start.
pub(super) fn with_best_rule<'a>(data: Data<'a>, settings: &Settings) -> Data<'a> {
    let rules = data.noise.rules(settings);
    if rules.len() == 1 || settings.input_map != InputMap::Borders {
        return data;
    }
    let structure = Structure { order: settings.order.unwrap_or(2), delay: settings.delay.unwrap_or(-1) };
    let knots = settings.knots.unwrap_or(FIRST_KNOTS);
    let error = |data: &Data| {
        let ladder = Ladder::new(data, settings.input_map, knots);
        let segments = ladder.top().segments(structure);
        let fitted = ladder.climb_from_smaller(structure, Effort::SEARCH)?;
        let samples: usize = segments.iter().map(Segment::len).sum();
        Some(cost(structure, &fitted.theta, &segments) / samples as f64)
    };
    let tried = rules.into_iter().map(|rule| data.with_rule(rule)).filter_map(|d| Some((error(&d)?, d)));
    let best = tried.min_by(|x, y| x.0.total_cmp(&y.0));
    best.map_or_else(|| data.with_rule(data.rule), |(_, best)| best)
}

/// The best order of each delay, from assessments sorted by fit. A coarse grid may favour a delay that a finer one does not.
fn best_of_each_delay(sorted: &[Assessed]) -> impl Iterator<Item = &Assessed> {
    let is_first = |i: usize| sorted[..i].iter().all(|a| a.structure.delay != sorted[i].structure.delay);
    (0..sorted.len()).filter(move |&i| is_first(i) && sorted[i].fit_percent.is_finite()).map(|i| &sorted[i])
}

/// Sets an assessment against the best one.
fn candidate(assessed: &Assessed, best: &Assessed) -> Candidate {
    let excess: Vec<f64> = assessed.losses.iter().zip(&best.losses).map(|(x, y)| x - y).collect();
    let count = excess.len() as f64;
    let mean = excess.iter().sum::<f64>() / count;
    let variance = excess.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (count - 1.0);
    let error = (variance / count).sqrt();
    let behind = if mean == 0.0 { 0.0 } else { mean / error };
    Candidate {
        structure: assessed.structure,
        knots: assessed.knots,
        parameters: assessed.parameters,
        fit_percent: assessed.fit_percent,
        behind: if assessed.fit_percent.is_finite() { behind } else { f64::INFINITY },
    }
}
