//! Both experiments in one regression.

use super::arrow::ArrowFit;
use super::data::PulseData;
use super::experiments::{Experiments, first_level_value, satellite_value};
use super::fit::PulseFitError;
use super::solution::{Level, RelativeLevel, Solution, known_level, rank_one_level};

/// Descendant and ascendant experiment together: `a` and `b` shared, a constant column instead of step experiments.
///
/// ```text
/// y(t) = −Σᵢ aᵢ y(t−i) + κ + Σᵢ bᵢ w(t−i) + ξ(t),   κ = B(1)u_m
/// ```
///
/// where `w = u − u_m` is known to be 0 and 1 at the ends and `bᵢ w` is a free mean for every other (level, lag); then rank one
/// as in (3.24b) with the shared `b̂`. The constant makes a mean output from a step experiment, and its transient, needless.
/// Consistent for white equation error. An offset that differs between the two records would bias it.
///
/// # Errors
/// [`PulseFitError`] if the experiments do not excite every parameter.
pub(crate) fn joint(descendant: &PulseData, ascendant: &PulseData) -> Result<Solution, PulseFitError> {
    let experiments = Experiments::new(&[descendant, ascendant]);
    let columns = experiments.rank_free_columns();
    let fit = experiments.solve(&columns)?;
    let levels = rank_free_levels(&experiments, &fit);
    Solution::new(&experiments, columns, fit, levels, Level::Constant)
}

/// Levels of the regression with a free mean for every (level, lag), relative to `u_m`.
pub(crate) fn rank_free_levels(experiments: &Experiments<'_>, fit: &ArrowFit) -> Vec<Vec<RelativeLevel>> {
    let n = experiments.order();
    let of_experiment = |e: usize| {
        let branch = experiments.parts[e].branch;
        (0..experiments.parts[e].points())
            .map(|j| match j {
                0 => known_level(fit, first_level_value(branch)),
                _ => {
                    let mut level = rank_one_level(fit, n, experiments.rank_free_local(e, j, 1));
                    level.value += satellite_value(branch);
                    level
                }
            })
            .collect()
    };
    (0..experiments.parts.len()).map(of_experiment).collect()
}
