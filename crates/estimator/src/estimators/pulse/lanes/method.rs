//! The methods, eight replicates abreast.

use super::arrow::{LaneArrow, LaneColumns};
use super::constrained::Constrained;
use super::lane::{LANES, Lane};
use super::levels::Reading;
use super::statistics::LaneStatistics;
use super::wide::{Work, widest};
use crate::estimators::pulse::PulseMethod;
use crate::estimators::pulse::arrow::Columns;
use crate::estimators::pulse::experiments::{Experiments, first_level_value, satellite_value};
use crate::estimators::pulse::{linear_arx, memoryless, paper};

/// A level's value relative to the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LevelRule {
    /// Not estimated.
    Known(f64),
    /// (3.24b) from the local columns `first…first+n−1`, `plus` the satellite's value.
    RankOne { first: usize, plus: f64 },
    /// A local column itself.
    Local(usize),
}

/// A method for experiments of given designs: all that is the same in every replicate.
///
/// What [`PulseMethod::fit`] does for one replicate, [`LaneMethod::fit`] does for eight, without allocating. Replicates that it cannot
/// solve it leaves to the former, which knows what to say of them.
#[derive(Debug, Clone)]
pub struct LaneMethod {
    order: usize,
    columns: LaneColumns,
    levels: Vec<LevelRule>,
    constrained: Option<Constrained>,
}

/// Mean of the step experiment's output in each replicate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaneStep {
    /// `ŷ₀`.
    pub mean: Lane,
    /// Samples averaged.
    pub samples: f64,
}

/// Estimates of eight replicates with their standard errors; memory that is used again and again.
#[derive(Debug, Clone, Default)]
pub struct LaneFit {
    /// `a`, `b`, then the border points: the order of [`super::super::PulseFit::parameters`].
    pub values: Vec<Lane>,
    /// Their standard errors.
    pub errors: Vec<Lane>,
    /// Whether the replicate has an estimate; if not, ask [`PulseMethod::fit`] why.
    pub sound: [bool; LANES],
    pub(super) arrow: LaneArrow,
    gradients: Vec<Lane>,
}

impl LaneMethod {
    /// The method of `example` for experiments of the same designs.
    pub fn of(example: &PulseMethod<'_>) -> Self {
        let experiments = Experiments::new(&example.experiments());
        let n = experiments.order();
        let rank_one = |first: usize, plus: f64| LevelRule::RankOne { first, plus };
        let mut constrained = None;
        let (columns, levels) = match example {
            PulseMethod::Paper { experiment, .. } => {
                let first = first_level_value(experiment.branch) - satellite_value(experiment.branch);
                let inner = (1..experiment.points()).map(|j| rank_one((j - 1) * n, 0.0));
                (
                    paper::pulse_columns(&experiments),
                    std::iter::once(LevelRule::Known(first)).chain(inner).collect(),
                )
            }
            PulseMethod::Joint { .. } => (experiments.rank_free_columns(), rank_free(&experiments)),
            PulseMethod::Efficient(_) => {
                let start = rank_free(&experiments);
                let mut next = 0..;
                let levels = start.iter().map(|rule| match rule {
                    LevelRule::RankOne { .. } => LevelRule::Local(next.next().unwrap_or_default()),
                    known => *known,
                });
                let levels = levels.collect();
                constrained = Some(Constrained::new(&experiments, start));
                (experiments.rank_free_columns(), levels)
            }
            PulseMethod::LinearArx(_) => {
                let (columns, positions) = linear_arx::columns(&experiments);
                (columns, positions.into_iter().flatten().map(LevelRule::Known).collect())
            }
            PulseMethod::Memoryless(_) => {
                let (columns, curve) = memoryless::columns(&experiments);
                let levels =
                    curve.of_experiment.iter().zip(&experiments.parts).flat_map(|(indices, part)| {
                        let inner = indices.iter().map(|k| rank_one(k * n, 0.0));
                        std::iter::once(LevelRule::Known(first_level_value(part.branch))).chain(inner)
                    });
                (columns, levels.collect())
            }
        };
        Self { order: n, columns: broadcast(&columns), levels, constrained }
    }

    /// The estimates from the statistics of the method's experiments, in their order, and of the step experiment for the paper's methods.
    pub fn fit(&self, parts: &[&LaneStatistics], step: Option<LaneStep>, fit: &mut LaneFit) {
        widest(Fit { method: self, parts, step, fit });
    }
}

/// [`LaneMethod::fit`] on its way.
struct Fit<'a> {
    method: &'a LaneMethod,
    parts: &'a [&'a LaneStatistics],
    step: Option<LaneStep>,
    fit: &'a mut LaneFit,
}

impl Work for Fit<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { method, parts, step, fit } = self;
        let LaneFit { values, errors, sound, arrow, gradients } = fit;
        let shift = match step {
            Some(step) => step.mean,
            None => Lane::ZERO,
        };
        arrow.solve(parts, shift, &method.columns);
        if let Some(constrained) = &method.constrained {
            constrained.iterate(parts, arrow);
        }
        values.clear();
        errors.clear();
        *sound = arrow.sound;
        let reading = Reading::new(arrow, method.order, step);
        for k in 0..2 * method.order {
            reading.coefficient(k, gradients, values, errors);
        }
        for rule in &method.levels {
            reading.level(*rule, gradients, values, errors);
        }
        for x in values.iter().chain(errors.iter()) {
            for (sound, x) in sound.iter_mut().zip(x.0) {
                *sound &= x.is_finite();
            }
        }
    }
}

/// Levels of the regression with a free mean for every (level, lag), as in `joint`.
fn rank_free(experiments: &Experiments<'_>) -> Vec<LevelRule> {
    experiments
        .parts
        .iter()
        .enumerate()
        .flat_map(|(e, part)| {
            let plus = satellite_value(part.branch);
            let inner = (1..part.points()).map(move |j| (e, j, plus));
            std::iter::once(LevelRule::Known(first_level_value(part.branch))).chain(
                inner.map(|(e, j, plus)| LevelRule::RankOne {
                    first: experiments.rank_free_local(e, j, 1),
                    plus,
                }),
            )
        })
        .collect()
}

/// The same columns in every replicate.
pub(super) fn broadcast(columns: &Columns) -> LaneColumns {
    let groups = columns.offset.len();
    let mut saturated = vec![false; groups];
    for column in &columns.local {
        if let [(q, _)] = column.support[..] {
            saturated[q] = true;
        }
    }
    LaneColumns {
        width: columns.shared.ncols(),
        shared: columns.shared.transpose().iter().map(|x| Lane::splat(*x)).collect(),
        offset: columns.offset.iter().map(|o| Lane::splat(*o)).collect(),
        saturated,
        local: columns
            .local
            .iter()
            .map(|c| c.support.iter().map(|&(q, w)| (q, Lane::splat(w))).collect())
            .collect(),
    }
}
