//! What the elimination of the free means makes of the errors of eight replicates, with the first order: a constant linear map of the score.

use super::profile::ProfilePlan;
use super::sample::LaneSample;
use super::statistics::LaneStatistics;
use super::terms::LaneTerms;
use crate::pulse::solution::{Level, Solution};
use switchback_noise::lanes::{Lane, keep_apart};

/// [`Limit::terms`](super::super::Limit::terms) as a constant linear map of the score, and of what the profile score adds to it.
///
/// The score is a sum `λ_i` a lag and `r_q` a group, and the normal equations are an arrow: so it is first carried to the core, then
/// from there and from the few groups of its own to each parameter,
///
/// ```text
/// g_d = [d ≤ n] λ_d + Σ_q G_q,d r_q        first order of θ_k = (Σ_d H_k,d g_d + Σ_{q ∈ k} h_k,q r_q) + s_k (ŷ₀ − y₀)
/// p_d − g_d                                second             = Σ_d H_k,d (p_d − g_d)
/// ```
///
/// `O((n + p)(Q + K))` for `Q` groups and `K` parameters, not `O(QK)`. A group with a mean of its own adds to `p` nothing at all on `a`, so that
/// `p − g` is what it adds to `g`, with the sign changed: it costs an addition.
#[derive(Debug, Clone)]
pub(crate) struct ProfileControl {
    /// What the limit was taken about.
    reference: f64,
    /// The limit's `a`.
    a: Vec<f64>,
    /// The limit's mean of each group.
    means: Vec<f64>,
    /// `G`, one row a group.
    to_core: Vec<f64>,
    /// One a parameter.
    parameters: Vec<Answer>,
    /// Group and `h`, parameter by parameter.
    own: Vec<(usize, f64)>,
    /// `H`, one row a parameter.
    from_core: Vec<f64>,
    /// `y₀`, that is `ŷ₀` at the limit.
    step_mean: f64,
    profile: ProfilePlan,
}

/// What one parameter takes of the score beside the core's.
#[derive(Debug, Clone)]
struct Answer {
    /// Its entries of [`ProfileControl::own`] begin where those of the one before end, and end here.
    own_end: usize,
    /// `s`, the derivative in `ŷ₀`.
    step_slope: f64,
}

impl ProfileControl {
    pub(crate) fn of(solution: &Solution) -> Self {
        let Solution { fit, columns, order, .. } = solution;
        let answers: Vec<_> = solution.quantities.iter().map(|q| fit.answer(columns, &q.gradient)).collect();
        let own = answers.iter().flat_map(|(_, own)| own).copied().collect();
        let mut own_end = 0;
        Self {
            reference: solution.reference,
            a: fit.core.rows(0, *order).iter().copied().collect(),
            to_core: fit.core_sides(columns, *order),
            from_core: answers.iter().flat_map(|(core, _)| core.iter().copied()).collect(),
            parameters: answers
                .iter()
                .zip(&solution.quantities)
                .map(|((_, own), q)| {
                    own_end += own.len();
                    Answer { own_end, step_slope: q.step_slope }
                })
                .collect(),
            own,
            means: fit.group_means(columns),
            profile: ProfilePlan::of(fit, columns, *order),
            step_mean: match solution.level {
                Level::Constant => 0.0,
                Level::Step(step) => step.mean,
            },
        }
    }

    /// Lags and core parameters.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.a.len(), self.from_core.len() / self.parameters.len())
    }

    /// The terms of one sample.
    #[inline(always)]
    pub(super) fn carry<const N: usize, const D: usize>(
        &self,
        sample: &LaneSample<'_>,
        LaneTerms { first, second, residuals, .. }: &mut LaneTerms,
    ) {
        residuals.resize(self.means.len(), Lane::ZERO);
        let (core, shift) = self.to_core::<N, D>(sample.parts, residuals);
        let step = match sample.step {
            Some(step) => step.mean - Lane::splat(self.step_mean),
            None => Lane::ZERO,
        };
        first.resize(self.parameters.len(), Lane::ZERO);
        second.resize(self.parameters.len(), Lane::ZERO);
        let (from_core, _) = self.from_core.as_chunks::<D>();
        let mut own_start = 0;
        let terms = first.iter_mut().zip(second);
        for ((answer, weights), (first, second)) in self.parameters.iter().zip(from_core).zip(terms) {
            keep_apart();
            let (mut sum, mut shifted) = (Lane::ZERO, Lane::ZERO);
            for d in 0..D {
                sum += core[d] * weights[d];
            }
            // The profile score moves a and b only.
            for d in 0..2 * N {
                shifted += shift[d] * weights[d];
            }
            for &(group, weight) in &self.own[own_start..answer.own_end] {
                keep_apart();
                sum += residuals[group] * weight;
            }
            own_start = answer.own_end;
            *first = sum + step * answer.step_slope;
            *second = shifted;
        }
    }

    /// `g`, and what the profile score adds to it; and `r_q = Σ_{t∈q} r(t)`, with `r` the residual at the limit's parameters.
    #[inline(always)]
    fn to_core<const N: usize, const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        residuals: &mut [Lane],
    ) -> ([Lane; D], [Lane; D]) {
        let reference = Lane::splat(self.reference);
        let a: &[f64; N] = self.a.first_chunk().expect("the order is that of the code that was chosen");
        let (mut core, mut shift) = ([Lane::ZERO; D], [Lane::ZERO; D]);
        let weights = self.to_core.as_chunks::<D>().0.iter().zip(&self.profile.alone);
        let mut constants = weights.zip(&self.means).zip(&mut *residuals);
        for part in parts {
            let within = &part.within[..(N + 1) * (N + 1)];
            for i in 0..N {
                let row = (i + 1) * (N + 1);
                let mut sum = within[row];
                for l in 0..N {
                    sum += within[row + 1 + l] * a[l];
                }
                core[i] -= sum;
            }
            let groups = part.means.chunks_exact(N + 1).zip(&part.counts);
            for ((mean, &count), (((weights, &alone), &limit), into)) in groups.zip(&mut constants) {
                keep_apart();
                let mut residual = mean[0] - reference - Lane::splat(limit);
                for l in 0..N {
                    residual += (mean[l + 1] - reference) * a[l];
                }
                let residual = residual * count;
                for i in 0..N {
                    let product = (Lane::splat(weights[i]) - (mean[i + 1] - reference)) * residual;
                    core[i] += product;
                    if alone {
                        shift[i] -= product;
                    }
                }
                for d in N..D {
                    core[d] += residual * weights[d];
                }
                *into = residual;
            }
        }
        self.profile.add_tied::<N, D>(parts, residuals, reference, &mut shift);
        (core, shift)
    }
}
