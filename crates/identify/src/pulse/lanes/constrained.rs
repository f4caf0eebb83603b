//! The iteration of the rank-one constrained estimator, eight replicates abreast.

use super::arrow::{Core, Equations, Locals, Regression};
use super::columns::{ColumnPlan, ColumnValues};
use super::factor::dot;
use super::statistics::LaneStatistics;
use crate::pulse::efficient::{CONVERGED, MOST_STEPS, constrained_columns};
use crate::pulse::experiments::Experiments;
use crate::pulse::level_rule::LevelRule;
use switchback_noise::lanes::{LANES, Lane, keep_apart};

/// What is constant in the Gauss–Newton iteration of `efficient`.
#[derive(Debug, Clone)]
pub(super) struct Constrained {
    /// One local column a level.
    plan: ColumnPlan,
    /// Right where no level is estimated.
    values: ColumnValues,
    /// How the joint regression reads each estimated level: `first` and `plus` of [`LevelRule::RankOne`].
    start: Vec<(usize, f64)>,
}

impl Constrained {
    /// For experiments whose joint regression reads its levels by `start`.
    pub(super) fn new(experiments: &Experiments<'_>, start: &[Vec<LevelRule>]) -> Self {
        let (plan, values) = ColumnPlan::of(&constrained_columns(experiments), false);
        let start = start.iter().flatten().filter_map(|rule| rule.rank_one()).collect();
        Self { plan, values, start }
    }

    /// From the joint regression to convergence. A replicate that has converged stays where it is while the others go on.
    ///
    /// `locals` are those of `start` on entry; `values` is scratch.
    #[inline(always)]
    pub(super) fn iterate<const N: usize, const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        start: &Core<N, D>,
        locals: &mut Locals,
        values: &mut ColumnValues,
    ) -> Core<N, D> {
        let mut b = [Lane::ZERO; N];
        b.copy_from_slice(&start.parameters[N..2 * N]);
        let inverse = Lane::splat(1.0) / dot(&b, &b);
        let mut w: Vec<Lane> = self
            .start
            .iter()
            .map(|&(first, plus)| dot(&b, &locals.values[first..first + N]) * inverse + Lane::splat(plus))
            .collect();
        values.copy_from(&self.values);
        let mut moving = [true; LANES];
        let mut steps = 0;
        loop {
            self.linearise(values, &b, &w);
            let regression = Regression { parts, shift: Lane::ZERO, plan: &self.plan, values };
            let equations = Equations::<D>::of::<N>(&regression, locals);
            let core = Core::<N, D>::solve(&equations, &regression);
            core.follow(&regression, locals);
            let change = change(&core, locals, &b, &w);
            for l in 0..LANES {
                // A replicate that came to nothing moves no further: its change is not a number.
                moving[l] &= change.0[l] >= CONVERGED;
            }
            if steps == MOST_STEPS || moving == [false; LANES] {
                return core;
            }
            let new = core.parameters[N..2 * N].iter().chain(&locals.values);
            for (old, new) in b.iter_mut().chain(&mut w).zip(new) {
                keep_apart();
                *old = new.where_or(&moving, *old);
            }
            steps += 1;
        }
    }

    /// The regression linearised about `b` and `w`.
    #[inline(always)]
    fn linearise<const N: usize>(&self, values: &mut ColumnValues, b: &[Lane; N], w: &[Lane]) {
        let (groups, weights) = (self.plan.support.as_chunks::<N>().0, values.weights.as_chunks_mut::<N>().0);
        for ((groups, w), weights) in groups.iter().zip(w).zip(weights) {
            keep_apart();
            for (lag, (&q, b)) in groups.iter().zip(b).enumerate() {
                values.shared[q * self.plan.width + lag] = *w;
                values.offset[q] = Lane::ZERO - *b * *w;
            }
            *weights = *b;
        }
    }
}

/// The largest change relative to the largest `b`, or to the level.
#[inline(always)]
fn change<const N: usize, const D: usize>(
    core: &Core<N, D>,
    locals: &Locals,
    b: &[Lane; N],
    w: &[Lane],
) -> Lane {
    let new_b = &core.parameters[N..2 * N];
    let (mut largest, mut of_b, mut of_w) = (Lane::ZERO, Lane::ZERO, Lane::ZERO);
    for (old, new) in b.iter().zip(new_b) {
        largest = largest.larger(new.abs());
        of_b = of_b.larger((*new - *old).abs());
    }
    for (old, new) in w.iter().zip(&locals.values) {
        keep_apart();
        of_w = of_w.larger((*new - *old).abs() / new.abs().larger(Lane::splat(1.0)));
    }
    (of_b / largest).larger(of_w)
}
