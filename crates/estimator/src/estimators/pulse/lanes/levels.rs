//! Reading parameters and their standard errors off a solved arrow: `Solution`, eight replicates abreast.

use super::arrow::{LaneArrow, dot};
use super::lane::Lane;
use super::method::{LaneStep, LevelRule};

/// What all levels of a fit share: the base, its gradient, and the step experiment's error.
pub(super) struct Reading<'a> {
    arrow: &'a LaneArrow,
    order: usize,
    base: Lane,
    /// Derivative of the base in every `aᵢ`, in every `bᵢ`, and in `κ`.
    base_slopes: [Lane; 3],
    step: Option<StepError>,
    /// `Σ bᵢ²`.
    norm: Lane,
}

struct StepError {
    a_at_one: Lane,
    /// Direct derivative of the base in `ŷ₀`.
    direct: Lane,
    variance: Lane,
}

impl<'a> Reading<'a> {
    #[inline(always)]
    pub(super) fn new(arrow: &'a LaneArrow, order: usize, step: Option<LaneStep>) -> Self {
        let (a, rest) = arrow.core.split_at(order);
        let b = &rest[..order];
        let one = Lane::splat(1.0);
        let (mut a_at_one, mut b_at_one) = (one, Lane::ZERO);
        for (a, b) in a.iter().zip(b) {
            a_at_one += *a;
            b_at_one += *b;
        }
        let inverse = one / b_at_one;
        let (held, output) = match step {
            None => (rest[order], Lane::ZERO),
            Some(step) => (a_at_one * step.mean, step.mean),
        };
        let base = held * inverse;
        let step = match step {
            Some(LaneStep { samples, .. }) => {
                let variance = arrow.variance / (a_at_one * a_at_one * samples);
                Some(StepError { a_at_one, direct: a_at_one * inverse, variance })
            }
            None => None,
        };
        let base_slopes = [output * inverse, Lane::ZERO - base * inverse, inverse];
        Self { arrow, order, base, base_slopes, step, norm: dot(b, b) }
    }

    /// `aᵢ` or `bᵢ`: core parameter `k`.
    #[inline(always)]
    pub(super) fn coefficient(
        &self,
        k: usize,
        gradient: &mut Vec<Lane>,
        values: &mut Vec<Lane>,
        errors: &mut Vec<Lane>,
    ) {
        gradient.clear();
        gradient.resize(self.arrow.size, Lane::ZERO);
        gradient[k] = Lane::splat(1.0);
        values.push(self.arrow.core[k]);
        errors.push(self.error(gradient, [Lane::ZERO; 3]));
    }

    /// A border point.
    #[inline(always)]
    pub(super) fn level(
        &self,
        rule: LevelRule,
        gradient: &mut Vec<Lane>,
        values: &mut Vec<Lane>,
        errors: &mut Vec<Lane>,
    ) {
        let n = self.order;
        gradient.clear();
        for (slope, count) in self.base_slopes.iter().zip([n, n, self.arrow.size - 2 * n]) {
            gradient.extend(std::iter::repeat_n(*slope, count));
        }
        let direct = match &self.step {
            Some(step) => step.direct,
            None => Lane::ZERO,
        };
        let (mut own, mut weights) = (Lane::ZERO, Lane::ZERO);
        let relative = match rule {
            LevelRule::Known(value) => Lane::splat(value),
            LevelRule::Local(local) => {
                self.through_local(gradient, local, Lane::splat(1.0), (&mut own, &mut weights));
                self.arrow.local[local]
            }
            LevelRule::RankOne { first, plus } => {
                let b = &self.arrow.core[n..2 * n];
                let h = &self.arrow.local[first..first + n];
                let inverse = Lane::splat(1.0) / self.norm;
                let value = dot(b, h) * inverse;
                for i in 0..n {
                    gradient[n + i] += (h[i] - b[i] * value * 2.0) * inverse;
                    self.through_local(gradient, first + i, b[i] * inverse, (&mut own, &mut weights));
                }
                value + Lane::splat(plus)
            }
        };
        values.push(self.base + relative);
        errors.push(self.error(gradient, [own, weights, direct]));
    }

    /// Carries the weight of a local column over to the core; adds its own variance, and the weight.
    #[inline(always)]
    fn through_local(
        &self,
        gradient: &mut [Lane],
        local: usize,
        weight: Lane,
        (own, weights): (&mut Lane, &mut Lane),
    ) {
        *own += weight * weight / self.arrow.own[local];
        *weights += weight;
        for (g, slope) in gradient.iter_mut().zip(self.arrow.slope(local)) {
            *g -= weight * *slope;
        }
    }

    /// Delta method; `own` the local columns' own variance, `weights` the sum of their weights, `direct` the derivative in `ŷ₀`.
    #[inline(always)]
    fn error(&self, gradient: &mut [Lane], [own, weights, direct]: [Lane; 3]) -> Lane {
        let mut through_step = Lane::ZERO;
        if let Some(step) = &self.step {
            // A constant left in y moves every free mean by itself and the core by `constant`.
            let slope = direct - step.a_at_one * (dot(gradient, &self.arrow.constant) + weights);
            through_step = slope * slope * step.variance;
        }
        (self.arrow.variance * (own + self.arrow.quadratic(gradient)) + through_step).sqrt()
    }
}
