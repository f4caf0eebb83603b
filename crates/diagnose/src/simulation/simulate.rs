//! Free-run simulation of a fitted model over a record.

use std::ops::Range;

use switchback_model::linear::is_stable;

use crate::likelihood::design::Design;
use crate::likelihood::engine::Fit;
use crate::model::augmented::{AugmentedModel, BorderColumn, convolve};
use crate::model::borders::Grid;
use crate::model::linear::Linear;
use crate::records::dataset::{Dataset, ScaledRecord};
use crate::simulation::initial_conditions::{
    Level, set_by_first_samples, set_level, with_initial_conditions, with_level,
};

/// Outputs beyond this many standard deviations are those of an unstable model; the bound keeps its error finite.
pub(crate) const LIMIT: f64 = 1e6;

/// The output that the model predicts from the input alone; the samples before the first counted one are the measured ones
/// and set the initial state. Dimensionless units.
pub(crate) fn free_run(dataset: &Dataset, fit: &Fit, number: usize, scaled: &ScaledRecord) -> Vec<f64> {
    let prepared = Prepared::new(dataset, (&fit.grid, &fit.augmented), number, scaled);
    let x = prepared.run(&fit.linear, Begins::Measured { variance: fit.variance });
    prepared.read(scaled, &x)
}

/// Where a free run begins.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Begins {
    /// From the outputs measured before the first counted sample, where errors have the given variance.
    Measured {
        /// Variance of the equation error.
        variance: f64,
    },
    /// From rest at the first input, where it has been for ever.
    Rest,
}

/// A record laid out for free runs of a model, however often its linear parameters change.
pub(crate) struct Prepared<'a> {
    grid: &'a Grid,
    augmented: &'a AugmentedModel,
    /// The augmented model with what only this record has.
    begun: AugmentedModel,
    design: Design,
    /// Equation columns of initial conditions that were added.
    added: Range<usize>,
    /// Those of the level, where every fitted record has a drift path of its own.
    level: Range<usize>,
}

impl<'a> Prepared<'a> {
    /// Lays out a record that is given with its number in the dataset.
    pub(crate) fn new(
        dataset: &Dataset,
        (grid, augmented): (&'a Grid, &'a AugmentedModel),
        number: usize,
        scaled: &ScaledRecord,
    ) -> Self {
        let begun = started(augmented, number);
        let (with, added) = with_initial_conditions(dataset, &begun);
        let (with, level) = with_level(&with, number);
        let design = Design::of(dataset, grid, &with, &[(number, scaled)]);
        Self { grid, augmented, begun, design, added, level }
    }

    /// The output before the sensor, one value a sample; given ones before the first counted sample.
    pub(crate) fn run(&self, linear: &Linear, begins: Begins) -> Vec<f64> {
        let effect_term = &self.design.scaled_records[0];
        let mut u = self.design.input(effect_term, &linear.f);
        if self.begun != *self.augmented {
            start(&mut u, &self.design, (self.grid, self.augmented, linear), begins);
        }
        let b = convolve(&linear.b, &self.design.taps);
        let mut p = linear.padded(self.grid.len(), &self.design.augmented);
        if let Some(level) = Level::of(self.augmented, &linear.d).filter(|_| !self.level.is_empty()) {
            let measured = match begins {
                Begins::Measured { variance } => Some((&self.design, effect_term, variance)),
                Begins::Rest => None,
            };
            set_level(&mut p, level, self.level.clone(), measured);
        }
        if let Begins::Measured { variance } = begins {
            set_by_first_samples(&mut p, &self.design, effect_term, (self.added.clone(), variance));
        }
        let d = effect_term.columns.coefficients(&p.d);
        let beside = |t: usize| d.iter().zip(effect_term.columns.row(t));
        let mut x = match begins {
            Begins::Measured { .. } => effect_term.x[..effect_term.from].to_vec(),
            Begins::Rest => {
                let driven = b.iter().sum::<f64>() * u[0] + beside(0).map(|(d, psi)| d * psi).sum::<f64>();
                let rest = driven / (1.0 + linear.a.iter().sum::<f64>());
                vec![rest.clamp(-LIMIT, LIMIT); effect_term.from]
            }
        };
        for t in effect_term.from..effect_term.x.len() {
            let mut now = 0.0;
            for (i, a) in linear.a.iter().enumerate() {
                now -= a * x[t - i - 1];
            }
            for (j, b) in b.iter().enumerate() {
                now += b * u[t.saturating_sub(j + 1)];
            }
            for (d, psi) in beside(t) {
                now += d * psi;
            }
            x.push(now.clamp(-LIMIT, LIMIT));
        }
        x
    }

    /// What the sensor makes of a run; the measured outputs before the first counted sample.
    pub(crate) fn read(&self, scaled: &ScaledRecord, x: &[f64]) -> Vec<f64> {
        let from = self.design.scaled_records[0].from;
        let mut y = scaled.y[..from].to_vec();
        y.extend(x[from..].iter().map(|x| sensed(self.augmented, *x)));
        y
    }
}

/// The reading of an output.
pub(crate) fn sensed(augmented: &AugmentedModel, x: f64) -> f64 {
    let y = augmented.curve.read(x);
    match augmented.saturation {
        Some(s) => y.clamp(s.low, s.high),
        None => y,
    }
}

/// Whether a model has no free run: its `A` is unstable, or its output has come to the bound, or is no number.
pub(crate) fn runs_away<'a>(fit: &Fit, runs: impl IntoIterator<Item = &'a [f64]>) -> bool {
    let leaves = |y: &f64| !y.is_finite() || y.abs() >= LIMIT;
    !is_stable(&fit.linear.a) || runs.into_iter().any(|run| run.iter().any(leaves))
}

/// The augmented model with an unknown start of the working point for a record that was not fitted, where fitted records have one.
fn started(augmented: &AugmentedModel, number: usize) -> AugmentedModel {
    let mut out = augmented.clone();
    let is_start = |c: &BorderColumn| matches!(c, BorderColumn::Start { .. });
    let start = BorderColumn::Start { scaled: number };
    if !out.border_columns.contains(&start)
        && let Some(any) = out.border_columns.iter().position(is_start)
    {
        out.border_columns[any] = start;
    }
    out
}

/// Sets the start of the working point by the equation errors before the first counted sample, the only ones a simulation may
/// look at; the present start is that of another record. At rest the working point starts where it would without any.
fn start(
    u: &mut [f64],
    design: &Design,
    (grid, augmented, linear): (&Grid, &AugmentedModel, &Linear),
    begins: Begins,
) {
    let effect_term = &design.scaled_records[0];
    let is_start = |c: &BorderColumn| matches!(c, BorderColumn::Start { .. });
    let Some(at) = augmented.border_columns.iter().position(is_start) else { return };
    let mut unit = vec![0.0; linear.f.len()];
    unit[grid.len() + at] = 1.0;
    let shape = design.input(effect_term, &unit);
    let other = linear.f[grid.len() + at];
    u.iter_mut().zip(&shape).for_each(|(u, s)| *u -= other * s);
    if let Begins::Rest = begins {
        return;
    }
    let b = convolve(&linear.b, &design.taps);
    let (a, x) = (&linear.a, &effect_term.x);
    let through = |u: &[f64], t: usize| -> f64 { b.iter().enumerate().map(|(j, b)| b * u[t - j - 1]).sum() };
    let (mut cross, mut energy) = (0.0, 1e-300);
    for t in a.len().max(b.len())..effect_term.from {
        let left: f64 = x[t] + a.iter().enumerate().map(|(i, a)| a * x[t - i - 1]).sum::<f64>();
        let response = through(&shape, t);
        cross += (left - through(u, t)) * response;
        energy += response * response;
    }
    u.iter_mut().zip(&shape).for_each(|(u, s)| *u += cross / energy * s);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::testing::{noise_free, small_dataset, small_model};

    #[test]
    fn what_leaves_every_range_runs_away_and_nothing_else_does() {
        let (dataset, grid) = small_dataset();
        let truth = small_model(&grid);
        let dataset = noise_free(dataset, &grid, &AugmentedModel::default(), &truth);
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        let mut fit = fit(context, &|_| AugmentedModel::default(), &[], &truth, 5).expect("a fit");
        let run = |fit: &Fit| free_run(&dataset, fit, 0, &dataset.scaled_records[0]);
        assert!(!runs_away(&fit, [&run(&fit)[..]]));
        // A stable model whose run is no number, or beyond the bound.
        assert!(runs_away(&fit, [&[0.0, f64::NAN][..]]) && runs_away(&fit, [&[0.0, -LIMIT][..]]));
        // Poles outside the unit circle: a short record need not show it, the coefficients do.
        fit.linear.a = vec![-2.2, 1.21];
        let away = run(&fit);
        assert!(away.iter().all(|y| y.is_finite()) && away.iter().any(|y| y.abs() >= LIMIT));
        assert!(runs_away(&fit, [&away[..]]) && runs_away(&fit, [&away[..20]]));
    }
}
