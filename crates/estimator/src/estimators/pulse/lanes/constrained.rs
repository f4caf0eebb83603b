//! The iteration of the rank-one constrained estimator, eight replicates abreast.

use super::arrow::{LaneArrow, LaneColumns, dot};
use super::lane::{LANES, Lane};
use super::method::{LevelRule, broadcast};
use super::statistics::LaneStatistics;
use crate::estimators::pulse::efficient::{CONVERGED, MOST_STEPS};
use crate::estimators::pulse::experiments::Experiments;

/// What is constant in the Gauss–Newton iteration of `efficient`.
#[derive(Debug, Clone)]
pub(super) struct Constrained {
    order: usize,
    /// The columns of the joint regression: right where no level is estimated.
    columns: LaneColumns,
    /// The estimated levels.
    levels: Vec<Level>,
}

#[derive(Debug, Clone)]
struct Level {
    /// Its group at each lag.
    groups: Vec<usize>,
    /// Its local columns in the joint regression begin here.
    first: usize,
    plus: f64,
}

impl Constrained {
    /// For experiments whose joint regression reads its levels by `start`.
    pub(super) fn new(experiments: &Experiments<'_>, start: Vec<LevelRule>) -> Self {
        let n = experiments.order();
        let inner =
            experiments.parts.iter().enumerate().flat_map(|(e, p)| (0..p.points()).map(move |j| (e, j)));
        let levels: Vec<Level> = inner
            .zip(start)
            .filter_map(|((e, j), rule)| match rule {
                LevelRule::RankOne { first, plus } => Some(Level {
                    groups: (1..=n).map(|lag| experiments.group(e, j, lag)).collect(),
                    first,
                    plus,
                }),
                _ => None,
            })
            .collect();
        let mut columns = broadcast(&experiments.rank_free_columns());
        columns.saturated.fill(false);
        columns.local = levels.iter().map(|l| l.groups.iter().map(|q| (*q, Lane::ZERO)).collect()).collect();
        Self { order: n, columns, levels }
    }

    /// From the joint regression to convergence. A replicate that has converged stays where it is while the others go on.
    #[inline(always)]
    pub(super) fn iterate(&self, parts: &[&LaneStatistics], arrow: &mut LaneArrow) {
        let n = self.order;
        let mut columns = self.columns.clone();
        let mut b = arrow.core[n..2 * n].to_vec();
        let inverse = Lane::splat(1.0) / dot(&b, &b);
        let mut w: Vec<Lane> = self
            .levels
            .iter()
            .map(|l| dot(&b, &arrow.local[l.first..l.first + n]) * inverse + Lane::splat(l.plus))
            .collect();
        self.linearise(&mut columns, &b, &w);
        arrow.solve(parts, Lane::ZERO, &columns);
        let mut moving = [true; LANES];
        for _ in 0..MOST_STEPS {
            for (l, moving) in moving.iter_mut().enumerate() {
                *moving = *moving && moved(arrow, n, &b, &w, l) >= CONVERGED;
                if *moving {
                    b.iter_mut().zip(&arrow.core[n..]).for_each(|(b, new)| b.0[l] = new.0[l]);
                    w.iter_mut().zip(&arrow.local).for_each(|(w, new)| w.0[l] = new.0[l]);
                }
            }
            if !moving.contains(&true) {
                break;
            }
            self.linearise(&mut columns, &b, &w);
            arrow.solve(parts, Lane::ZERO, &columns);
        }
    }

    /// The regression linearised about `b` and `w`.
    #[inline(always)]
    fn linearise(&self, columns: &mut LaneColumns, b: &[Lane], w: &[Lane]) {
        for ((level, w), support) in self.levels.iter().zip(w).zip(&mut columns.local) {
            for (lag, (&q, b)) in level.groups.iter().zip(b).enumerate() {
                columns.shared[q * columns.width + lag] = *w;
                columns.offset[q] = Lane::ZERO - *b * *w;
                support[lag].1 = *b;
            }
        }
    }
}

/// The largest change of replicate `l` relative to the largest value.
#[inline(always)]
fn moved(arrow: &LaneArrow, n: usize, b: &[Lane], w: &[Lane], l: usize) -> f64 {
    let new_b = &arrow.core[n..2 * n];
    let largest = new_b.iter().fold(0.0_f64, |m, x| m.max(x.0[l].abs()));
    let of_b = b.iter().zip(new_b).map(|(old, new)| (new.0[l] - old.0[l]).abs() / largest);
    let of_w =
        w.iter().zip(&arrow.local).map(|(old, new)| (new.0[l] - old.0[l]).abs() / new.0[l].abs().max(1.0));
    of_b.chain(of_w).fold(0.0, f64::max)
}
