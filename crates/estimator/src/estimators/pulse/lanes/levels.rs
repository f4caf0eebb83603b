//! Reading parameters and their variances off a solved arrow: `Solution`, eight replicates abreast.

use super::arrow::{Core, Locals, dot};
use super::method::{LaneStep, LevelRule};
use crate::lanes::Lane;

/// What all levels of a fit share: the base, its gradient, and the step experiment's error.
pub(super) struct Reading<'a, const N: usize, const D: usize> {
    core: &'a Core<N, D>,
    locals: &'a Locals,
    /// Whether the local columns depend on `a` alone.
    apart: bool,
    base: Lane,
    base_gradient: [Lane; D],
    step: Option<StepError>,
    /// `1/Σ bᵢ²`.
    inverse_norm: Lane,
    /// `bᵢ/Σ bᵢ²`.
    weights: [Lane; N],
}

struct StepError {
    a_at_one: Lane,
    /// Direct derivative of the base in `ŷ₀`.
    direct: Lane,
    variance: Lane,
}

/// A parameter and the variance of its estimate.
pub(super) type Read = (Lane, Lane);

impl<'a, const N: usize, const D: usize> Reading<'a, N, D> {
    #[inline(always)]
    pub(super) fn new(
        core: &'a Core<N, D>,
        (locals, apart): (&'a Locals, bool),
        step: Option<LaneStep>,
    ) -> Self {
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
        Self { core, locals, apart, base, base_gradient, step, inverse_norm, weights }
    }

    /// `aᵢ` or `bᵢ`: core parameter `k`.
    #[inline(always)]
    pub(super) fn coefficient(&self, k: usize) -> Read {
        let mut gradient = [Lane::ZERO; D];
        gradient[k] = Lane::splat(1.0);
        (self.core.parameters[k], self.variance(gradient, [Lane::ZERO; 3]))
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
                self.through_local(&mut gradient, local, Lane::splat(1.0), (&mut own, &mut through));
                self.locals.values[local]
            }
            LevelRule::RankOne { first, plus } => {
                let h = &self.locals.values[first..first + N];
                let value = dot(&self.weights, h);
                for i in 0..N {
                    let b = self.core.parameters[N + i];
                    gradient[N + i] += (h[i] - b * (value + value)) * self.inverse_norm;
                    self.through_local(&mut gradient, first + i, self.weights[i], (&mut own, &mut through));
                }
                value + Lane::splat(plus)
            }
        };
        (self.base + relative, self.variance(gradient, [own, through, direct]))
    }

    /// Carries the weight of a local column over to the core; adds its own variance, and the weight.
    #[inline(always)]
    fn through_local(
        &self,
        gradient: &mut [Lane; D],
        local: usize,
        weight: Lane,
        (own, weights): (&mut Lane, &mut Lane),
    ) {
        *own += weight * weight * self.locals.inverse[local];
        *weights += weight;
        let slope = self.locals.slope::<D>(local);
        for k in 0..N {
            gradient[k] -= weight * slope[k];
        }
        if !self.apart {
            for k in N..D {
                gradient[k] -= weight * slope[k];
            }
        }
    }

    /// Delta method; `own` the local columns' own variance, `weights` the sum of their weights, `direct` the derivative in `ŷ₀`.
    #[inline(always)]
    fn variance(&self, gradient: [Lane; D], [own, weights, direct]: [Lane; 3]) -> Lane {
        let mut through_step = Lane::ZERO;
        if let Some(step) = &self.step {
            // A constant left in y moves every free mean by itself and the core by `constant`.
            let slope = direct - step.a_at_one * (dot(&gradient, &self.core.constant) + weights);
            through_step = slope * slope * step.variance;
        }
        self.core.variance * (own + self.core.quadratic(gradient)) + through_step
    }
}
