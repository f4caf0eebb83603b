//! Order, delay and number of knots, chosen by cross-validation on the fit records.

use super::cross_validation::{Assessed, assess};
use super::data::FOLDS;
use super::data::{Data, Featured};
use super::error::FreeError;
use super::fit::{FIRST_KNOTS, Fitted, Ladder};
use super::problem::{Segment, Structure};
use super::progress::Progress;
use super::rules::rules;
use super::runs::Runs;
use super::settings::{InputMap, Settings};
use super::simulation_error::{Effort, Refinement, cost, whitened_cost};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::ops::RangeInclusive;
use switchback_model::noise_model::noise_model;

/// Probability of a choice by chance.
const LEVEL: f64 = 0.05;
/// Orders tried.
const ORDERS: RangeInclusive<usize> = 1..=4;
/// Delays tried. −1: no delay at all; −2: `y` answers one sample before `v` shows, as when the sensor of `v` lags.
const DELAYS: RangeInclusive<isize> = -2..=1;
/// The longest delay tried where the best is late: a dead time.
const LONGEST_DELAY: isize = 30;
/// Knots a curve tried, [`FIRST_KNOTS`] among them.
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
    /// How far its squared error exceeds the best candidate's, in standard errors of the difference over blocks.
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

/// Chooses what the settings leave open, and fits it to the blocks.
///
/// In turn: knots for a middling structure, order and delay at these knots, knots for these. Longer delays are tried while the best is late. The criterion is the free run over blocks of
/// time left out of the fit ([`assess`]), each started from its own first outputs. Of the numbers of knots within one standard error of the best the least is taken (the
/// one-standard-error rule of L. Breiman et al., "Classification and Regression Trees", 1984, §3.4.3): neighbours differ by less than
/// chance, and the smaller ones travel better to records that the fit has not seen.
///
/// A larger order or another delay must do more. A dozen structures are compared, so that the least of their errors is low by chance alone. Either the
/// gain is beyond chance for the best of so many ([`sure_gain`]), or it exceeds its standard error and the BIC of the errors filtered by the noise model of
/// the best candidate is lower, too: BIC takes a superfluous coefficient for real with a probability of P(χ²₁ > ln N), 0.3 % for 5,000 samples
/// (G. Schwarz, Ann. Statist. 6 (1978)), but is of no use where no structure holds, as the free run and the filtered errors then want different ones.
pub(super) fn select(
    data: &Data,
    settings: &Settings,
    progress: &dyn Progress,
) -> Result<(Selection, Option<Fitted>), FreeError> {
    let orders: Vec<usize> = settings.order.map_or(ORDERS.collect(), |n| vec![n]);
    let delays: Vec<isize> =
        settings.delay.map_or(DELAYS.filter(|&d| settings.allows(d)).collect(), |d| vec![d]);
    let knots: Vec<usize> = match (settings.input_map, settings.knots) {
        (InputMap::Linear, _) => vec![2],
        (_, Some(k)) => vec![k],
        _ => KNOTS.to_vec(),
    };
    // Smaller structures first: by falling delay, then by order.
    let structures: Vec<Structure> = delays
        .iter()
        .rev()
        .flat_map(|&delay| orders.iter().map(move |&order| Structure { order, delay }))
        .collect();
    if let ([structure], [knots]) = (&structures[..], &knots[..]) {
        return Ok((
            Selection { candidates: Vec::new(), folds: 0, structure: *structure, knots: *knots },
            None,
        ));
    }
    let search = Search { data, settings, progress };
    progress.found(2 * (knots.len() + structures.len()));
    search.run(&structures, &knots)
}

/// Fits and their cross-validation on the blocks of a search.
struct Search<'a> {
    data: &'a Data<'a>,
    settings: &'a Settings,
    progress: &'a dyn Progress,
}

impl Search<'_> {
    fn run(
        &self,
        structures: &[Structure],
        knots: &[usize],
    ) -> Result<(Selection, Option<Fitted>), FreeError> {
        let first_knots = if knots.len() == 1 { knots[0] } else { FIRST_KNOTS };
        let ladder = Ladder::new(self.data, self.settings.input_map, first_knots);
        let top = ladder.top();
        let assessed = |structures: &[Structure]| -> Vec<Assessed> {
            let fits = self.coarse(&ladder, structures);
            fits.into_iter().map(|fit| self.assessed(top, fit)).collect()
        };
        let mut coarse = assessed(structures);
        while let Some(later) = self.later(structures, &coarse) {
            self.progress.found(2 * later.len());
            let more = assessed(&later);
            // Too few samples are left beside so long a delay.
            if more.is_empty() {
                break;
            }
            coarse.extend(more);
        }
        let Some(middling) = least(&coarse) else { return Err(self.refusal(top, structures)) };
        let by_knots = self.along(middling, knots, first_knots);
        let Some(chosen) = most_parsimonious(&by_knots) else { return Err(self.refusal(top, structures)) };
        let count = chosen.knots;
        let at_knots: Vec<Assessed> = if count == middling.knots {
            coarse
        } else {
            let featured = self.data.featured(chosen.fitted.basis.clone());
            coarse.iter().filter_map(|coarse| self.refit(&featured, &coarse.fitted)).collect()
        };
        let structure = self.structure(&at_knots).unwrap_or(chosen);
        let mut all = self.along(structure, knots, structure.knots);
        let best = most_parsimonious(&all).unwrap_or(structure).clone();
        all.extend(at_knots.iter().filter(|a| a.structure() != structure.structure()).cloned());
        all.sort_by(|x, y| y.fit_percent.total_cmp(&x.fit_percent));
        let candidates = all.iter().map(|a| candidate(a, &all[0])).collect();
        let selection =
            Selection { candidates, folds: FOLDS, structure: best.structure(), knots: best.knots };
        Ok((selection, Some(best.fitted)))
    }

    /// The structures with one sample of delay more than any assessed, while the best is no earlier than those assessed first end, and a numerator of the
    /// largest order at its delay, which imitates longer ones, reaches beyond these; none where the delay is known.
    fn later(&self, structures: &[Structure], assessed: &[Assessed]) -> Option<Vec<Structure>> {
        let most = assessed.iter().map(|a| a.structure().delay).max()?;
        let is_open = self.settings.delay.is_none() && (*DELAYS.end()..LONGEST_DELAY).contains(&most);
        let best = least(assessed)?.structure().delay;
        let is_late = best >= *DELAYS.end() && best + *ORDERS.end() as isize > most;
        let latest = structures.iter().filter(|s| s.delay == *DELAYS.end());
        let later = latest.map(|s| Structure { delay: most + 1, ..*s });
        (is_open && is_late).then(|| later.collect())
    }

    /// A fit of every structure on the coarse grid, smaller ones first: each starts from those inside it.
    fn coarse(&self, ladder: &Ladder, structures: &[Structure]) -> Vec<Fitted> {
        if self.settings.refine {
            let fits = ladder.climb_all(structures, Effort::SEARCH, |rung, s| rung.search_blocks(s, FOLDS));
            return fits.into_iter().flatten().collect();
        }
        let one_shot = |&s| ladder.one_shot(s, &ladder.top().search_blocks(s, FOLDS));
        structures.iter().filter_map(one_shot).collect()
    }

    fn assessed(&self, featured: &Featured, fitted: Fitted) -> Assessed {
        let blocks = featured.search_blocks(fitted.structure, FOLDS);
        self.progress.did_one();
        assess(featured, fitted, &blocks)
    }

    /// The same structure on another basis.
    fn refit(&self, featured: &Featured, fitted: &Fitted) -> Option<Assessed> {
        let structure = fitted.structure;
        let blocks = featured.search_blocks(structure, FOLDS);
        let next = if self.settings.refine {
            featured.lifted(fitted, &blocks, Effort::SEARCH)
        } else {
            featured.one_shot(structure, &blocks)
        };
        next.map(|next| self.assessed(featured, next))
    }

    /// One structure with every number of knots: finer grids from the next coarser one, coarser ones from the next finer one.
    fn along(&self, start: &Assessed, knots: &[usize], at: usize) -> Vec<Assessed> {
        let mut all = vec![start.clone()];
        let finer = knots.iter().filter(|&&k| k > at);
        let coarser = knots.iter().rev().filter(|&&k| k < at);
        for counts in [finer.copied().collect::<Vec<_>>(), coarser.copied().collect()] {
            let mut last = start.fitted.clone();
            for count in counts {
                let featured = self.data.featured(self.data.basis(self.settings.input_map, count));
                if let Some(next) = self.refit(&featured, &last) {
                    last = next.fitted.clone();
                    all.push(next);
                }
            }
        }
        all
    }

    /// Order and delay: from the smallest on, the next one that gains more than chance.
    fn structure<'b>(&self, assessed: &'b [Assessed]) -> Option<&'b Assessed> {
        let best = least(assessed)?;
        let filter = {
            let featured = self.data.featured(best.fitted.basis.clone());
            let runs = Runs::new(featured.search_blocks(best.structure(), FOLDS));
            noise_model(&runs.residuals(best.structure(), &best.fitted.theta))
        };
        let sure = sure_gain(assessed.len());
        let mut ordered: Vec<&Assessed> = assessed.iter().filter(|a| a.fit_percent.is_finite()).collect();
        ordered.sort_by_key(|a| a.parameters);
        let mut ordered = ordered.into_iter();
        let mut now = ordered.next()?;
        let mut bic: Option<f64> = None;
        for next in ordered {
            let gain = candidate(now, next).behind;
            if gain > sure {
                (now, bic) = (next, None);
            } else if gain > 1.0 {
                let (of_now, of_next) =
                    (bic.unwrap_or_else(|| self.bic(now, &filter)), self.bic(next, &filter));
                (now, bic) = if of_next < of_now { (next, Some(of_next)) } else { (now, Some(of_now)) };
            }
        }
        Some(now)
    }

    /// BIC of the errors filtered by `D`, at the parameters that make these least.
    fn bic(&self, assessed: &Assessed, filter: &[f64]) -> f64 {
        let Assessed { fitted, parameters, .. } = assessed;
        let featured = self.data.featured(fitted.basis.clone());
        let blocks = featured.search_blocks(fitted.structure, FOLDS);
        let samples: usize = blocks.iter().map(Segment::counted).sum();
        let curves: Vec<usize> = featured.basis.sizes().collect();
        let refinement = Refinement { whitening: filter, ..Refinement::new(Effort::SEARCH, &curves) };
        let theta = refinement.run(fitted.structure, fitted.theta.clone(), &blocks);
        let mean = whitened_cost(fitted.structure, &theta, &blocks, filter) / samples as f64;
        samples as f64 * mean.ln() + *parameters as f64 * (samples as f64).ln()
    }

    /// Why no structure has a cross-validation: without a block the smallest must still have its two samples a parameter.
    fn refusal(&self, featured: &Featured, structures: &[Structure]) -> FreeError {
        let smallest = structures[0];
        let mut blocks = featured.search_blocks(smallest, FOLDS);
        blocks.pop();
        featured
            .basis
            .check_length(smallest, &blocks)
            .err()
            .unwrap_or(FreeError::Unstable { order: smallest.order })
    }
}

/// The gain in standard errors that the best of so many structures without merit reaches with probability [`LEVEL`] at most: Bonferroni's bound on
/// Student's distribution, as the error comes from the scatter over the blocks.
fn sure_gain(structures: usize) -> f64 {
    let student = StudentsT::new(0.0, 1.0, (FOLDS - 1) as f64).expect("positive degrees of freedom");
    student.inverse_cdf(1.0 - LEVEL / structures.max(1) as f64)
}

/// The assessment of least error, if any is finite.
fn least(assessed: &[Assessed]) -> Option<&Assessed> {
    let finite = assessed.iter().filter(|a| a.fit_percent.is_finite());
    finite.max_by(|x, y| x.fit_percent.total_cmp(&y.fit_percent))
}

/// Of those within one standard error of the best, the one with fewest parameters.
fn most_parsimonious(assessed: &[Assessed]) -> Option<&Assessed> {
    let best = least(assessed)?;
    let close = assessed.iter().filter(|a| candidate(a, best).behind <= 1.0);
    close.min_by_key(|a| a.parameters)
}

/// The data with the reversal rule that fits best.
///
/// The rules have the same parameters, so the fit itself decides; a middling structure shows the difference. All are judged
/// over the same samples but for a few at the very start.
pub(super) fn with_best_rule<'a>(data: Data<'a>, settings: &Settings) -> Data<'a> {
    let rules = rules(data.noise, settings);
    if rules.len() == 1 || settings.input_map != InputMap::Borders {
        return data;
    }
    let structure = Structure { order: settings.order.unwrap_or(2), delay: settings.delay.unwrap_or(-1) };
    let knots = settings.knots.unwrap_or(FIRST_KNOTS);
    let error = |data: &Data| {
        let ladder = Ladder::new(data, settings.input_map, knots);
        let segments = ladder.top().search_blocks(structure, FOLDS);
        let fitted = ladder.climb_from_smaller(structure)?;
        let samples: usize = segments.iter().map(Segment::counted).sum();
        Some(cost(structure, &fitted.theta, &segments) / samples as f64)
    };
    let tried = rules.into_iter().map(|rule| data.with_rule(rule)).filter_map(|d| Some((error(&d)?, d)));
    let best = tried.min_by(|x, y| x.0.total_cmp(&y.0));
    best.map_or_else(|| data.with_rule(data.rule), |(_, best)| best)
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
        structure: assessed.structure(),
        knots: assessed.knots,
        parameters: assessed.parameters,
        fit_percent: assessed.fit_percent,
        behind: if assessed.fit_percent.is_finite() { behind } else { f64::INFINITY },
    }
}
