//! Refined instrumental variables on the folds, eight replicates abreast: see `super::super::instrumental`.

mod normal_equations;
mod read;
mod spectrum;
mod start;
mod step;
pub(super) mod work;

use super::fit::LaneFit;
use super::sample::LaneSample;
use super::sized::{SizedWork, run_with_constant};
use super::statistics::LaneStatistics;
use crate::pulse::data::PulseData;
use crate::pulse::experiments::{first_level_value, satellite_value};
use crate::pulse::instrumental::STEPS;
use std::f64::consts::TAU;
use switchback_noise::lanes::{LANES, Lane, keep_apart};

/// All that is the same in every replicate, for experiments whose levels are visited once a period each, at the same phases in both.
///
/// The normal equations have three parts: the core `(a, b, o)`, and the levels of each experiment. A level's column is the response
/// to one pulse, so that two levels have in common what depends on their distance in time only, in both experiments alike; one
/// factor of that matrix eliminates the levels of both. What a level and a lag of the core have in common depends on their distance, too:
///
/// ```text
/// ψ_aᵢ = α e^{−jωi},  ψ_bᵢ = β e^{−jωi},  ψ_j = H e^{−jωτ_j},   H = B/A,  α = −H U/A,  β = U/A
/// ```
///
/// `O(T m n)` a step beside the `O(m³)` of that factor, not `O(T m²)`.
#[derive(Debug, Clone)]
pub(super) struct LaneFolds {
    period: usize,
    /// `w` at the satellite and at `V₁`, one entry an experiment.
    ends: Vec<[f64; 2]>,
    /// Phase of each level.
    phases: Vec<usize>,
    /// `cos` and `sin` of `ω_k p`, `T` a line.
    turns: Vec<[f64; 2]>,
    /// The distances in time between two levels, `V₁` apart.
    gaps: Vec<usize>,
    /// Which of them lies between any two, rows first.
    gap_of: Vec<usize>,
    /// Where the regression of the start has its rows: the phases whose lag window saw no level but `V₁`, each with the lag at which it did.
    known: Vec<(usize, Option<usize>)>,
}

impl LaneFolds {
    /// `None` where the experiments are no pair that the lanes know.
    pub(super) fn of(experiments: &[&PulseData]) -> Option<Self> {
        let order = experiments[0].order();
        let folds = experiments.iter().map(|data| data.folds.as_ref()).collect::<Option<Vec<_>>>()?;
        let visits = &folds[0].visits;
        if folds.iter().any(|other| other.visits != *visits) {
            return None;
        }
        let points = experiments[0].points();
        let at = |level: usize| {
            let mut at = (0..visits.len()).filter(|p| visits[*p] == Some(level));
            at.next().filter(|_| at.next().is_none())
        };
        let phases = (0..points).map(at).collect::<Option<Vec<_>>>()?;
        let period = visits.len();
        let turn = |(k, p): (usize, usize)| {
            let (sin, cos) = (TAU * ((k * p) % period) as f64 / period as f64).sin_cos();
            [cos, sin]
        };
        let lines = period / 2 + 1;
        let gap = |i: usize, j: usize| {
            let apart = phases[i].abs_diff(phases[j]);
            apart.min(period - apart)
        };
        let pairs: Vec<usize> =
            (1..points).flat_map(|i| (1..points).map(move |j| (i, j))).map(|(i, j)| gap(i, j)).collect();
        let mut gaps = pairs.clone();
        gaps.sort_unstable();
        gaps.dedup();
        let place = |gap: &usize| gaps.binary_search(gap).unwrap_or_default();
        let seen = |p: usize| {
            let back = |lag: usize| visits[(p + period * lag - lag) % period];
            (1..=order).find_map(|lag| Some((back(lag)?, lag)))
        };
        let known = (0..period).filter_map(|p| match seen(p) {
            None => Some((p, None)),
            Some((0, lag)) => Some((p, Some(lag))),
            Some(_) => None,
        });
        Some(Self {
            known: known.collect(),
            turns: (0..lines).flat_map(|k| (0..period).map(move |p| (k, p))).map(turn).collect(),
            gap_of: pairs.iter().map(place).collect(),
            ends: experiments
                .iter()
                .map(|d| [satellite_value(d.branch), first_level_value(d.branch)])
                .collect(),
            period,
            phases,
            gaps,
        })
    }

    /// The estimates from a sample; nothing where the order is not compiled.
    pub(super) fn fit(&self, order: usize, sample: &LaneSample<'_>, fit: &mut LaneFit) {
        if !run_with_constant(order, Fold { folds: self, sample, fit }) {
            fit.sound = [false; LANES];
        }
    }
}

/// [`LaneFolds::fit`] on its way.
struct Fold<'a> {
    folds: &'a LaneFolds,
    sample: &'a LaneSample<'a>,
    fit: &'a mut LaneFit,
}

impl SizedWork for Fold<'_> {
    #[inline(always)]
    fn run<const N: usize, const D: usize>(self) {
        let Self { folds, sample, fit } = self;
        folds.solve::<N, D>(sample.parts, fit);
    }
}

impl LaneFolds {
    fn lines(&self) -> usize {
        self.period / 2 + 1
    }

    /// `p − lag` in the period.
    #[inline(always)]
    fn before(&self, p: usize, lag: usize) -> usize {
        let lag = lag % self.period;
        if p >= lag { p - lag } else { p + self.period - lag }
    }

    #[inline(always)]
    fn solve<const N: usize, const D: usize>(&self, parts: &[&LaneStatistics], fit: &mut LaneFit) {
        let LaneFit { values, variances, sound, folded: work, .. } = fit;
        *sound = [parts.iter().all(|part| part.samples == parts[0].samples); LANES];
        let variance = self.weigh(parts, work, sound);
        self.transform(parts, work);
        let mut theta = self.start::<N, D>(parts, work, sound);
        // Every call is compiled anew: a first round before the loop would double its code.
        let mut steps = 0;
        let factor = loop {
            let factor = self.step::<N, D>(&mut theta, work, sound);
            steps += 1;
            if steps == STEPS {
                break factor;
            }
        };
        self.read::<N, D>(&theta, (&factor, variance), work, (values, variances));
        let mut spoilt = Lane::ZERO;
        for (value, variance) in values.iter().zip(&*variances) {
            keep_apart();
            spoilt += LaneFit::spoilt(*value, *variance);
        }
        fit.leave_out(spoilt);
    }
}
