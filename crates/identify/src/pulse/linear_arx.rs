//! The baseline without hysteresis or curve: a linear ARX model.

use super::arrow::Columns;
use super::data::PulseData;
use super::experiments::Experiments;
use super::layout::Layout;
use super::level_rule::LevelRule;
use switchback_model::hysteresis::Branch;

/// Least squares of `y(t) = −Σ aᵢ y(t−i) + Σ bᵢ v(t−i) + c`: what a user picks who knows of no nonlinearity.
///
/// In the paper's normalisation both borders are the straight line from `(h_m, u_m)` to `(h_M, u_M)`; it is wrong, and
/// its error stays, unless the borders are that line.
pub(super) fn layout(experiments: &Experiments<'_>) -> Layout {
    let position = |e: usize, level: usize| relative_position(experiments.parts[e], level);
    let columns = Columns {
        shared: experiments.core_columns(position),
        local: Vec::new(),
        offset: vec![0.0; experiments.statistics.groups()],
        bilinear: false,
    };
    let of_experiment = |(e, part): (usize, &&PulseData)| {
        (0..part.points()).map(|j| LevelRule::Known(position(e, j))).collect()
    };
    Layout { columns, levels: experiments.parts.iter().enumerate().map(of_experiment).collect() }
}

/// `(V_j − h_m)/(h_M − h_m)`.
fn relative_position(part: &PulseData, level: usize) -> f64 {
    let from_satellite = (part.levels[level] - part.satellite) / (part.levels[0] - part.satellite);
    match part.branch {
        Branch::Descending => 1.0 - from_satellite,
        Branch::Ascending => from_satellite,
    }
}
