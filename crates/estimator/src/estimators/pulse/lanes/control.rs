//! The control variate of eight replicates: a constant linear map of the score, in two steps.

use super::method::LaneSample;
use super::profile::ProfilePlan;
use super::sized::{SizedWork, run};
use super::statistics::LaneStatistics;
use crate::estimators::pulse::ErrorTerms;
use crate::lanes::{Lane, keep_apart};

/// [`Limit::terms`](super::super::Limit::terms) as a constant linear map of the score, and of what the profile score adds to it, over the number
/// of samples.
///
/// The score is a sum `λ_i` a lag and `r_q` a group, and the normal equations are an arrow: so it is first carried to the core, then
/// from there and from the few groups of its own to each parameter,
///
/// ```text
/// g_d = [d ≤ n] λ_d + Σ_q G_q,d r_q        first order of θ_k = (Σ_d H_k,d g_d + Σ_{q ∈ k} h_k,q r_q)/N + s_k (ŷ₀ − y₀)
/// p_d − g_d                                second             = Σ_d H_k,d (p_d − g_d)/N
/// ```
///
/// `O((n + p)(Q + K))` for `Q` groups and `K` parameters, not `O(QK)`. A group with a mean of its own adds to `p` nothing at all on `a`, so that
/// `p − g` is what it adds to `g`, with the sign changed: it costs an addition.
#[derive(Debug, Clone)]
pub struct LaneControl {
    /// What the limit was taken about.
    pub(crate) reference: f64,
    /// The limit's `a`.
    pub(crate) a: Vec<f64>,
    /// The limit's mean of each group.
    pub(crate) means: Vec<f64>,
    /// `G`, one row a group.
    pub(crate) to_core: Vec<f64>,
    /// One a parameter.
    pub(crate) parameters: Vec<Answer>,
    /// Group and `h`, parameter by parameter.
    pub(crate) own: Vec<(usize, f64)>,
    /// `H`, one row a parameter.
    pub(crate) from_core: Vec<f64>,
    /// `y₀`, that is `ŷ₀` at the limit.
    pub(crate) step_mean: f64,
    pub(crate) profile: ProfilePlan,
}

/// The leading terms of the errors of eight replicates, their exact means taken off; memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub struct LaneTerms {
    /// First order, one a parameter.
    pub first: Vec<Lane>,
    /// What the profile score holds of the second.
    pub second: Vec<Lane>,
    residuals: Vec<Lane>,
}

/// What one parameter takes of the score beside the core's.
#[derive(Debug, Clone)]
pub(crate) struct Answer {
    /// Its entries of [`LaneControl::own`] begin where those of the one before end, and end here.
    pub(crate) own_end: usize,
    /// `s`, the derivative in `ŷ₀`.
    pub(crate) step_slope: f64,
}

impl LaneControl {
    /// The leading terms of every parameter's error less their means, for each sample, in as many of `terms`.
    ///
    /// Nothing for the orders that [`LaneMethod::fit`](super::LaneMethod::fit) leaves to the solver that goes one by one.
    ///
    /// # Panics
    /// If there are fewer of `terms` than samples.
    pub fn terms(&self, samples: &[LaneSample<'_>], means: &ErrorTerms, terms: &mut [LaneTerms]) {
        let size = self.from_core.len() / self.parameters.len();
        let terms = &mut terms[..samples.len()];
        run(self.a.len(), size, Terms { control: self, samples, means, terms });
    }
}

/// [`LaneControl::terms`] on its way.
struct Terms<'a> {
    control: &'a LaneControl,
    samples: &'a [LaneSample<'a>],
    means: &'a ErrorTerms,
    terms: &'a mut [LaneTerms],
}

impl SizedWork for Terms<'_> {
    #[inline(always)]
    fn run<const N: usize, const D: usize>(self) {
        let Self { control, samples, means, terms } = self;
        for (sample, terms) in samples.iter().zip(terms) {
            keep_apart();
            control.carry::<N, D>(sample, means, terms);
        }
    }
}

impl LaneControl {
    /// The terms of one sample.
    #[inline(always)]
    fn carry<const N: usize, const D: usize>(
        &self,
        sample: &LaneSample<'_>,
        means: &ErrorTerms,
        LaneTerms { first, second, residuals }: &mut LaneTerms,
    ) {
        residuals.resize(self.means.len(), Lane::ZERO);
        let (core, shift) = self.to_core::<N, D>(sample.parts, residuals);
        let per_sample = 1.0 / sample.parts[0].samples;
        let step = match sample.step {
            Some(step) => step.mean - Lane::splat(self.step_mean),
            None => Lane::ZERO,
        };
        first.resize(self.parameters.len(), Lane::ZERO);
        second.resize(self.parameters.len(), Lane::ZERO);
        let (from_core, _) = self.from_core.as_chunks::<D>();
        let mut own_start = 0;
        let terms = first.iter_mut().zip(second).zip(means.first.iter().zip(&means.second));
        for ((answer, weights), ((first, second), (first_mean, second_mean))) in
            self.parameters.iter().zip(from_core).zip(terms)
        {
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
            *first = sum * per_sample + step * answer.step_slope - Lane::splat(*first_mean);
            *second = shifted * per_sample - Lane::splat(*second_mean);
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
