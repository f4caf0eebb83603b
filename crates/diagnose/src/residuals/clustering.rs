//! Whether outliers come by chance, or where the input is.
//!
//! Outliers know nothing of the machine's state. What a model misses at one place of the stroke, or soon after each reversal, comes
//! back at every passage: heavy tails imitate it one step ahead.
//!
//! ```text
//! a visit of ℓ samples to a cell sees an outlier with probability e = 1 − (1 − ρ)^ℓ,   ρ their share of all samples
//! z = (visits that saw one − Σ e)/√(Σ e·(1 − e))
//! ```

use crate::likelihood::design::{Design, DesignScaled};
use crate::likelihood::engine::Fit;
use crate::likelihood::weights::weigh;
use crate::records::dataset::{Dataset, ScaledRecord};
use crate::records::motion::Motion;

/// Equal parts of the stroke on each border.
const EFFECT_TERMS: usize = 16;
/// Visits that a cell needs to be judged; the share of them that see an outlier, or how many times as many see one as by chance; and
/// the distance from chance.
const VISITS: usize = 6;
const MOST: f64 = 0.5;
const OFTEN: f64 = 3.0;
const FAR: f64 = 6.0;
/// Share of all outliers in such cells from which they are none.
const BOUND: f64 = 0.3;

/// What is known of one cell.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    visits: usize,
    hits: usize,
    /// Sum of `e` and of `e·(1 − e)`.
    expected: f64,
    variance: f64,
    outliers: usize,
}

impl Cell {
    fn add(&mut self, (samples, outliers): (usize, usize), share: f64) {
        let e = 1.0 - (1.0 - share).powi(samples as i32);
        self.visits += 1;
        self.hits += usize::from(outliers > 0);
        self.expected += e;
        self.variance += e * (1.0 - e);
        self.outliers += outliers;
    }

    fn is_haunted(&self) -> bool {
        let hits = self.hits as f64;
        let distance = (hits - self.expected) / self.variance.max(1e-9).sqrt();
        let least = f64::min(MOST * self.visits as f64, OFTEN * self.expected);
        self.visits >= VISITS && hits > least && distance > FAR
    }
}

/// One record: the cell of each sample, and whether it is an outlier.
struct Seen {
    cells: Vec<usize>,
    outliers: Vec<bool>,
}

/// Whether many of the outliers of a fitted mixture come back where the input does; never without a mixture.
pub(crate) fn come_where_the_input_is(dataset: &Dataset, fit: &Fit) -> bool {
    if fit.augmented.noise.mixture.is_none() {
        return false;
    }
    let design = fit.design();
    let Some(outliers) = outliers(&design, fit) else { return false };
    let seen = |cell: fn(&Motion, f64) -> usize| {
        let of_scaled = |((known, scaled), outliers): ((&DesignScaled, &ScaledRecord), &Vec<bool>)| {
            // What is counted first answers the input one sample before.
            let before = scaled.from - 1..scaled.v.len() - 1;
            let cells = before.map(|t| cell(&known.moves[t], scaled.v[t])).collect();
            Seen { cells, outliers: outliers.clone() }
        };
        design.scaled_records.iter().zip(dataset.fit()).zip(&outliers).map(of_scaled).collect::<Vec<Seen>>()
    };
    are_bound(&seen(at_place)) || are_bound(&seen(after_reversal)) || are_bound(&seen(travelled))
}

/// A part of the stroke on one of the borders.
fn at_place(m: &Motion, v: f64) -> usize {
    let effect_term = ((v.clamp(0.0, 1.0) * EFFECT_TERMS as f64) as usize).min(EFFECT_TERMS - 1);
    if m.branch > 0.0 { EFFECT_TERMS + effect_term } else { effect_term }
}

/// One sample, two, four, … after a reversal.
fn after_reversal(m: &Motion, _: f64) -> usize {
    (m.since + 1).ilog2() as usize
}

/// A 64th of the stroke after a reversal, two, four, …
fn travelled(m: &Motion, _: f64) -> usize {
    (m.travel * 64.0 + 1.0).log2() as usize
}

/// The counted samples that belong rather to the wide part of the mixture.
fn outliers(design: &Design, fit: &Fit) -> Option<Vec<Vec<bool>>> {
    let noise = &fit.augmented.noise;
    let (_, ratio) = noise.mixture?;
    let innovations = design.innovations(&fit.linear, &design.whitener(noise, &fit.linear.a));
    let scale = weigh(design, noise, &fit.linear, &innovations).scale?;
    let least = 0.5 * (1.0 + 1.0 / (ratio * ratio));
    let is_outlier = |s: &f64| *s > 0.0 && s * s < least;
    Some(scale.iter().map(|s| s.iter().map(is_outlier).collect()).collect())
}

/// Whether cells that outliers come back to hold many of them.
fn are_bound(seen: &[Seen]) -> bool {
    let outliers = || seen.iter().flat_map(|s| &s.outliers);
    let total = outliers().filter(|o| **o).count();
    let share = total as f64 / outliers().count().max(1) as f64;
    let cells = visited(seen, share);
    let haunted: usize = cells.iter().filter(|c| c.is_haunted()).map(|c| c.outliers).sum();
    haunted as f64 > BOUND * total.max(1) as f64
}

/// The cells with their visits, which are runs of samples; `share` is that of outliers among all samples.
fn visited(seen: &[Seen], share: f64) -> Vec<Cell> {
    let count = seen.iter().flat_map(|s| &s.cells).max().map_or(0, |most| most + 1);
    let mut cells = vec![Cell::default(); count];
    for Seen { cells: places, outliers } in seen {
        let mut from = 0;
        for visit in places.chunk_by(|x, y| x == y) {
            let here = &outliers[from..from + visit.len()];
            cells[visit[0]].add((visit.len(), here.iter().filter(|o| **o).count()), share);
            from += visit.len();
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// A record that passes eight cells again and again, with outliers where `is_outlier` says so of a cell and a visit to it.
    fn record(mut is_outlier: impl FnMut(usize, usize) -> bool) -> Vec<Seen> {
        const CELLS: usize = 8;
        const SAMPLES: usize = 12;
        let cells: Vec<usize> = (0..6000).map(|t| t / SAMPLES % CELLS).collect();
        let outliers = cells.iter().enumerate().map(|(t, cell)| is_outlier(*cell, t / SAMPLES)).collect();
        vec![Seen { cells, outliers }]
    }

    #[test]
    fn outliers_by_chance_are_bound_to_no_place() {
        for (seed, share) in [(1, 0.002), (2, 0.02), (3, 0.2)] {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            assert!(!are_bound(&record(|_, _| rng.random_bool(share))), "{share}");
        }
    }

    #[test]
    fn bursts_by_chance_are_bound_to_no_place() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut left = 0;
        let bursts = record(|_, _| {
            left = if rng.random_bool(0.004) { 6 } else { i32::max(left - 1, 0) };
            left > 0
        });
        assert!(!are_bound(&bursts));
    }

    #[test]
    fn what_is_missed_at_each_passage_is_bound_to_its_place() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        assert!(are_bound(&record(|cell, _| cell == 3 && rng.random_bool(0.3))));
        // In the first two passages only.
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        assert!(!are_bound(&record(|cell, visit| cell == 3 && visit < 16 && rng.random_bool(0.3))));
    }

    #[test]
    fn what_is_missed_at_one_passage_in_five_and_nowhere_else_is_bound_to_its_place() {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        assert!(are_bound(&record(|cell, _| cell == 3 && rng.random_bool(0.02))));
    }

    #[test]
    fn a_few_at_one_place_among_many_by_chance_leave_them_outliers() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        assert!(!are_bound(&record(|cell, _| rng.random_bool(if cell == 3 { 0.1 } else { 0.05 }))));
    }
}
