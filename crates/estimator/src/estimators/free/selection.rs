//! Order, delay and number of knots, chosen by cross-validation on the fit records.

use super::data::{Data, Featured};
use super::error::FreeError;
use super::fit::{Effort, FIRST_KNOTS, Fitted, Ladder};
use super::problem::{Segment, Structure};
use super::settings::{InputMap, Settings};
use super::simulation_error::cost;
use std::ops::RangeInclusive;

/// Parts that the fit records are cut into; each is left out once.
const FOLDS: usize = 4;
/// Orders tried.
const ORDERS: RangeInclusive<usize> = 1..=4;
/// Delays tried. −1: no delay at all; −2: `y` answers one sample before `v` shows, as when the sensor of `v` lags.
const DELAYS: RangeInclusive<isize> = -2..=1;
/// Knots a curve tried in the second stage; the first stage has [`FIRST_KNOTS`].
const KNOTS: [usize; 6] = [3, 4, 5, 7, 10, 15];
/// Structures that reach the second stage.
const FINALISTS: usize = 3;

/// One candidate and what cross-validation says of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Order and delay.
    pub structure: Structure,
    /// Knots of each curve; 2 for a straight line.
    pub knots: usize,
    /// `100·(1 − √(Σ(y−ŷ)²/Σ(y−ȳ)²))`, free runs over blocks that the fit had not seen; the criterion.
    pub fit_percent: f64,
}

/// How the structure was chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Every candidate tried, best first; empty where the settings left nothing to choose.
    pub candidates: Vec<Candidate>,
    /// Blocks of time that were left out in turn.
    pub folds: usize,
    /// Order and delay chosen.
    pub structure: Structure,
    /// Knots of each curve chosen.
    pub knots: usize,
}

/// Chooses what the settings leave open.
///
/// First every order and delay at a middling number of knots, then every number of knots at the best of
/// these. The criterion is the free run over blocks of time left out of the fit, each started from its own first outputs.
pub(super) fn select(data: &Data, settings: &Settings) -> Result<Selection, FreeError> {
    let orders: Vec<usize> = settings.order.map_or(ORDERS.collect(), |n| vec![n]);
    let delays: Vec<isize> = settings.delay.map_or(DELAYS.collect(), |d| vec![d]);
    let knots: Vec<usize> = match (settings.input_map, settings.knots) {
        (InputMap::Linear, _) => vec![2],
        (_, Some(k)) => vec![k],
        _ => KNOTS.to_vec(),
    };
    let first_knots = if knots.len() == 1 { knots[0] } else { FIRST_KNOTS };
    let structures: Vec<Structure> =
        orders.iter().flat_map(|&order| delays.iter().map(move |&delay| Structure { order, delay })).collect();
    if let ([structure], [knots]) = (&structures[..], &knots[..]) {
        return Ok(Selection { candidates: Vec::new(), folds: 0, structure: *structure, knots: *knots });
    }
    let ladder = Ladder::new(data, settings.input_map, first_knots);
    let mut assessed: Vec<Assessed> =
        structures.iter().map(|&structure| assess(&ladder, structure, settings.refine, None)).collect();
    assessed.sort_by(|x, y| y.fit_percent.total_cmp(&x.fit_percent));
    let mut candidates: Vec<Candidate> = assessed.iter().map(|a| a.candidate(first_knots)).collect();
    for &k in knots.iter().filter(|&&k| k != first_knots) {
        let ladder = Ladder::last_step(data, settings.input_map, k);
        for finalist in assessed.iter().take(FINALISTS).filter(|a| a.fit_percent.is_finite()) {
            let next = assess(&ladder, finalist.structure, settings.refine, Some(&finalist.folds));
            candidates.push(next.candidate(k));
        }
    }
    candidates.sort_by(|x, y| y.fit_percent.total_cmp(&x.fit_percent));
    let best = candidates[0];
    if !best.fit_percent.is_finite() {
        return Err(FreeError::Unstable { order: best.structure.order });
    }
    Ok(Selection { folds: FOLDS, structure: best.structure, knots: best.knots, candidates })
}

/// A structure, its score, and its fit to the rest of each fold.
#[derive(Debug)]
struct Assessed {
    structure: Structure,
    fit_percent: f64,
    folds: Vec<Fitted>,
}

impl Assessed {
    fn candidate(&self, knots: usize) -> Candidate {
        Candidate { structure: self.structure, knots, fit_percent: self.fit_percent }
    }
}

/// Cross-validates one structure at the top of a ladder, from each fold's earlier fit where there is one.
fn assess(ladder: &Ladder, structure: Structure, refine: bool, below: Option<&[Fitted]>) -> Assessed {
    let (mut missed, mut energy) = (0.0, 0.0);
    let mut folds = Vec::with_capacity(FOLDS);
    for fold in 0..FOLDS {
        let rest = |f| blocks(f, structure, fold, false);
        let fitted = if refine {
            ladder.climb(structure, Effort::SEARCH, below.map(|b| &b[fold]), rest)
        } else {
            ladder.one_shot(structure, &rest(ladder.top()))
        };
        let Some(fitted) = fitted else {
            return Assessed { structure, fit_percent: f64::NEG_INFINITY, folds: Vec::new() };
        };
        let left_out = blocks(ladder.top(), structure, fold, true);
        missed += cost(structure, &fitted.theta, &left_out);
        energy += left_out.iter().map(Segment::energy).sum::<f64>();
        folds.push(fitted);
    }
    Assessed { structure, fit_percent: 100.0 * (1.0 - (missed / energy).sqrt()), folds }
}

/// The blocks of one fold, or all the others.
fn blocks<'s>(featured: &'s Featured, structure: Structure, fold: usize, inside: bool) -> Vec<Segment<'s>> {
    let all = featured.blocks(structure, FOLDS).into_iter().enumerate();
    all.filter(|(i, _)| (i % FOLDS == fold) == inside).map(|(_, s)| s).collect()
}
