//! The baseline with a curve but no memory: a Hammerstein model with one static nonlinearity.

use super::arrow::{Columns, LocalColumn};
use super::data::PulseData;
use super::experiments::{Experiments, first_level_value};
use super::layout::Layout;
use super::level_rule::LevelRule;

/// Two levels nearer than this share of the interval are one level of the static curve.
const SAME_LEVEL: f64 = 1e-6;

/// Least squares with one curve for both directions, then rank one: what a user picks who knows a Hammerstein model but no hysteresis.
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + κ + Σᵢ bᵢ f(v(t−i)) + ξ(t),   f(h_m) = 0, f(h_M) = 1
/// ```
///
/// A level that both experiments visit has one value. On a single experiment it is right (memory is masked there); on both it is wrong wherever the
/// borders differ, and its error stays.
pub(super) fn layout(experiments: &Experiments<'_>) -> Layout {
    let n = experiments.order();
    let curve = StaticCurve::through(experiments);
    // At an inner level the shared part is the experiment without the pulse's lag; the local column adds bᵢf(V).
    let shared = experiments.core_columns(|e, level| match level {
        0 => first_level_value(experiments.parts[e].branch),
        _ => 0.0,
    });
    let local = (0..curve.levels.len())
        .flat_map(|k| (1..=n).map(move |lag| (k, lag)))
        .map(|(k, lag)| LocalColumn {
            support: curve.visits_of(k).map(|(e, j)| (experiments.group(e, j, lag), 1.0)).collect(),
        })
        .collect();
    let offset = vec![0.0; experiments.statistics.groups()];
    let of_experiment = |(indices, part): (&Vec<usize>, &&PulseData)| {
        let inner = indices.iter().map(|k| LevelRule::RankOne { first: k * n, plus: 0.0 });
        std::iter::once(LevelRule::Known(first_level_value(part.branch))).chain(inner).collect()
    };
    Layout {
        levels: curve.of_experiment.iter().zip(&experiments.parts).map(of_experiment).collect(),
        columns: Columns { shared, local, offset, bilinear: false },
    }
}

/// The distinct inner levels, and which of them each experiment visits.
struct StaticCurve {
    levels: Vec<f64>,
    /// For every experiment, the index into `levels` of its `V₂…V_m`.
    of_experiment: Vec<Vec<usize>>,
}

impl StaticCurve {
    fn through(experiments: &Experiments<'_>) -> Self {
        let mut levels: Vec<f64> = Vec::new();
        let of_experiment = experiments
            .parts
            .iter()
            .map(|part| {
                let tolerance = SAME_LEVEL * (part.levels[0] - part.satellite).abs();
                part.levels[1..]
                    .iter()
                    .map(|v| {
                        levels.iter().position(|l| (l - v).abs() <= tolerance).unwrap_or_else(|| {
                            levels.push(*v);
                            levels.len() - 1
                        })
                    })
                    .collect()
            })
            .collect();
        Self { levels, of_experiment }
    }

    /// Experiments and level indices (from 0, so at least 1) that visit level `k` of the curve.
    fn visits_of(&self, k: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.of_experiment.iter().enumerate().flat_map(move |(e, indices)| {
            indices.iter().enumerate().filter(move |(_, i)| **i == k).map(move |(j, _)| (e, j + 1))
        })
    }
}
