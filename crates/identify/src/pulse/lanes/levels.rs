//! Reading parameters and their variances off a solved arrow: `Solution`, eight replicates abreast.

use super::arrow::{Core, Locals, Regression};
use super::factor::dot;
use super::step::LaneStep;
use crate::pulse::level_rule::LevelRule;
use switchback_noise::lanes::Lane;

/// What all levels of a fit share: the base, its gradient, and the step experiment's error.
pub(super) struct Reading<'a, const N: usize, const D: usize> {
    core: &'a Core<N, D>,
    columns: LocalColumns<'a>,
    base: Lane,
    base_gradient: [Lane; D],
    step: Option<StepError>,
    /// `1/Σ bᵢ²`.
    inverse_norm: Lane,
    /// `bᵢ/Σ bᵢ²`.
    weights: [Lane; N],
}

/// Where the local columns are read.
#[derive(Clone, Copy)]
pub(super) enum LocalColumns<'a> {
    /// They are kept.
    Kept(&'a Locals),
    /// They are all own means, and depend on `a` alone: taken from the data when they are needed.
    Means(&'a Regression<'a>),
}

struct StepError {
    a_at_one: Lane,
    /// Direct derivative of the base in `ŷ₀`.
    direct: Lane,
    variance: Lane,
}

impl StepError {
    /// The variance that the step's mean brings to a quantity with this direct derivative in it, which a constant left in `y` moves so much.
    #[inline(always)]
    fn through(&self, direct: Lane, moved: Lane) -> Lane {
        let slope = direct - self.a_at_one * moved;
        slope * slope * self.variance
    }
}

/// A parameter and the variance of its estimate.
pub(super) type Read = (Lane, Lane);

impl<'a, const N: usize, const D: usize> Reading<'a, N, D> {
    #[inline(always)]
    pub(super) fn new(core: &'a Core<N, D>, columns: LocalColumns<'a>, step: Option<LaneStep>) -> Self {
        let (a, rest) = core.parameters.split_at(N);
        let b = &rest[..N];
        let one = Lane::splat(1.0);
        let (mut a_at_one, mut b_at_one) = (one, Lane::ZERO);
        for i in 0..N {
            a_at_one += a[i];
            b_at_one += b[i];
        }
        let inverse = one / b_at_one;
        let (held, output) = match step {
            None => (rest.get(N).copied().unwrap_or(Lane::ZERO), Lane::ZERO),
            Some(step) => (a_at_one * step.mean, step.mean),
        };
        let base = held * inverse;
        let step = match step {
            Some(LaneStep { samples, .. }) => {
                let variance = core.variance / (a_at_one * a_at_one * samples);
                Some(StepError { a_at_one, direct: a_at_one * inverse, variance })
            }
            None => None,
        };
        let slopes = [output * inverse, Lane::ZERO - base * inverse, inverse];
        let mut base_gradient = [Lane::ZERO; D];
        for k in 0..D {
            base_gradient[k] = slopes[k / N];
        }
        let inverse_norm = one / dot(b, b);
        let mut weights = [Lane::ZERO; N];
        for i in 0..N {
            weights[i] = b[i] * inverse_norm;
        }
        Self { core, columns, base, base_gradient, step, inverse_norm, weights }
    }

    /// `a`, then `b`: what the core begins with.
    #[inline(always)]
    pub(super) fn coefficients(&self, values: &mut [Lane], variances: &mut [Lane]) {
        let diagonal = self.core.inverse_diagonal();
        for (k, (value, variance)) in values.iter_mut().zip(variances).enumerate().take(2 * N) {
            let through_step = match &self.step {
                Some(step) => step.through(Lane::ZERO, self.core.constant[k]),
                None => Lane::ZERO,
            };
            *value = self.core.parameters[k];
            *variance = self.core.variance * diagonal[k] + through_step;
        }
    }

    /// A border point.
    #[inline(always)]
    pub(super) fn level(&self, rule: LevelRule) -> Read {
        let mut gradient = self.base_gradient;
        let direct = match &self.step {
            Some(step) => step.direct,
            None => Lane::ZERO,
        };
        let (mut own, mut through) = (Lane::ZERO, Lane::ZERO);
        let relative = match rule {
            LevelRule::Known(value) => Lane::splat(value),
            LevelRule::Local(local) => {
                let mut relative = [Lane::ZERO];
                self.through_locals(
                    &mut gradient,
                    (local, &[Lane::splat(1.0)]),
                    (&mut own, &mut through),
                    &mut relative,
                );
                relative[0]
            }
            LevelRule::RankOne { first, plus } => {
                let mut h = [Lane::ZERO; N];
                self.through_locals(&mut gradient, (first, &self.weights), (&mut own, &mut through), &mut h);
                let value = dot(&self.weights, &h);
                for i in 0..N {
                    let b = self.core.parameters[N + i];
                    gradient[N + i] += (h[i] - b * (value + value)) * self.inverse_norm;
                }
                value + Lane::splat(plus)
            }
        };
        (self.base + relative, self.variance(gradient, [own, through, direct]))
    }

    /// Carries the weights of the local columns from `first` on over to the core; adds their own variance, and the weights; reads the columns.
    #[inline(always)]
    fn through_locals<const K: usize>(
        &self,
        gradient: &mut [Lane; D],
        (first, weights): (usize, &[Lane; K]),
        (own, sum): (&mut Lane, &mut Lane),
        values: &mut [Lane; K],
    ) {
        for i in 0..K {
            let weight = weights[i];
            *sum += weight;
            match self.columns {
                LocalColumns::Means(regression) => {
                    let mean = regression.own_mean::<N>(first + i, &self.core.parameters);
                    *own += weight * weight * mean.inverse;
                    for k in 0..N {
                        gradient[k] -= weight * mean.slope[k];
                    }
                    values[i] = mean.value;
                }
                LocalColumns::Kept(locals) => {
                    *own += weight * weight * locals.inverse[first + i];
                    let slope = locals.slope::<D>(first + i);
                    for k in 0..D {
                        gradient[k] -= weight * slope[k];
                    }
                    values[i] = locals.values[first + i];
                }
            }
        }
    }

    /// Delta method; `own` the local columns' own variance, `weights` the sum of their weights, `direct` the derivative in `ŷ₀`.
    #[inline(always)]
    fn variance(&self, gradient: [Lane; D], [own, weights, direct]: [Lane; 3]) -> Lane {
        let through_step = match &self.step {
            // A constant left in y moves every free mean by itself and the core by `constant`.
            Some(step) => step.through(direct, dot(&gradient, &self.core.constant) + weights),
            None => Lane::ZERO,
        };
        self.core.variance * (own + self.core.quadratic(&gradient)) + through_step
    }
}
