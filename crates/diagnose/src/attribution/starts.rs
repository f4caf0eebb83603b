//! Which starts of which laws are worth a fit: a score test on top of a known model orders them.
//!
//! ```text
//! w(θ, p) ≈ w₀ + X·δ + α·(w(θₛ, p₀) − w₀) + Z·ζ,    gain = N ln(RSS₀/RSS)
//! ```
//!
//! `X` holds the known model's derivatives, computed once for all laws; the chord to the innovations at a start `θₛ` stands
//! for the law's nonlinear parameters (where it is nothing, their derivatives do), `Z` for the linear parameters that the law adds.

use std::sync::Arc;

use crate::attribution::explain::Hypothesis;
use crate::likelihood::design::{Design, Linear};
use crate::likelihood::engine::{Build, NonlinearParameter};
use crate::likelihood::gains::{Gains, Scored};
use crate::likelihood::jacobian::Jacobian;
use crate::likelihood::weights::{Weights, weigh};
use crate::model::augmented::{AugmentedModel, EquationColumn};
use crate::nominal::dynamics::dynamics_refitted;
use crate::records::dataset::Dataset;

/// A known model with what score tests on top of it share.
pub(crate) struct Known<'a> {
    pub(crate) dataset: &'a Dataset,
    pub(crate) hypothesis: &'a Hypothesis,
    /// The fit records under it.
    pub(crate) design: Arc<Design>,
    /// On the fit records, before weighting.
    pub(crate) innovations: Vec<Vec<f64>>,
    weights: Weights,
    weighted: Vec<f64>,
    jacobian: Jacobian,
}

impl<'a> Known<'a> {
    pub(crate) fn new(dataset: &'a Dataset, hypothesis: &'a Hypothesis) -> Self {
        let fit = &hypothesis.fit;
        let (design, noise) = (fit.design(), &fit.augmented.noise);
        let whitener = design.whitener(noise, &fit.linear.a);
        let innovations = design.innovations(&fit.linear, &whitener);
        let weights = weigh(&design, noise, &fit.linear, &innovations);
        let jacobian = Jacobian::new(&design, &fit.linear, &whitener, &weights);
        let weighted = weights.applied(&innovations);
        Self { dataset, hypothesis, design, innovations, weights, weighted, jacobian }
    }

    /// The test itself; nothing where the known parameters are not determined.
    pub(crate) fn test(&self) -> Option<ScoreTest<'_>> {
        let fit = &self.hypothesis.fit;
        let variance = fit.variance / self.dataset.criterion.share();
        Some(ScoreTest { known: self, gains: Gains::new(&self.jacobian, &self.weighted, variance)? })
    }
}

/// A score test of laws added to a known model.
pub(crate) struct ScoreTest<'a> {
    known: &'a Known<'a>,
    gains: Gains<'a>,
}

/// How promising a start is: approximate gains in deviance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Score {
    /// By the score test.
    pub(crate) linear: f64,
    /// With `A` and `B` solved for at the start itself, where a filter moves poles too far for a chord.
    pub(crate) refitted: Option<f64>,
}

impl Score {
    pub(crate) fn most(&self) -> f64 {
        self.refitted.map_or(self.linear, |refitted| refitted.max(self.linear))
    }
}

/// A change of the innovations smaller than this, in their standard deviations, is none.
const NOTHING: f64 = 1e-9;

impl ScoreTest<'_> {
    /// How promising a law that changes the augmented model to `build(known nonlinear parameters, those of the law)` is.
    pub(crate) fn score(&self, build: &Build<'_>, nonlinear: &[NonlinearParameter]) -> Score {
        let fit = &self.known.hypothesis.fit;
        let all: Vec<f64> = fit.nonlinear.iter().chain(nonlinear).map(|o| o.value).collect();
        let augmented = build(&all);
        let p = fit.linear.padded(fit.grid.len(), &augmented);
        let there = self.moved(&augmented, &p, &self.known.design);
        let mut columns = Vec::new();
        let chord = self.column(&self.known.innovations, &there.innovations, 1.0);
        if nonlinear.is_empty() || energy(&chord) > NOTHING * fit.variance {
            columns.push(chord);
        } else {
            for (j, o) in nonlinear.iter().enumerate() {
                let h = o.inward_step();
                let mut values = all.clone();
                values[fit.nonlinear.len() + j] += h;
                let beside = self.moved(&build(&values), &p, &there.design);
                columns.push(self.column(&there.innovations, &beside.innovations, 1.0 / h));
            }
        }
        columns.extend(self.added(&augmented, &p, &there));
        columns.retain(|c| energy(c) > NOTHING * fit.variance);
        let scored: Vec<Scored> = columns.into_iter().map(|c| self.gains.score(c)).collect();
        let n = fit.samples as f64;
        let share = self.gains.of(&scored.iter().collect::<Vec<_>>()) / n;
        let linear = -n * (1.0 - share.clamp(0.0, 0.999)).ln();
        Score { linear, refitted: self.refitted(&augmented, &p, &there) }
    }

    /// Columns of the linear parameters that the augmented model adds. What dies away at the start of a record orders nothing.
    fn added(&self, augmented: &AugmentedModel, p: &Linear, there: &Moved) -> Vec<Vec<f64>> {
        let known = &self.known.hypothesis.fit.linear;
        let whitener = there.design.whitener(&augmented.noise, &p.a);
        let with = |set: &dyn Fn(&mut Linear)| {
            let mut one = p.clone();
            set(&mut one);
            let moved = there.design.innovations(&one, &whitener);
            self.column(&there.innovations, &moved, 1.0)
        };
        let b = (known.b.len()..p.b.len()).map(|j| with(&|p| p.b[j] = 1.0));
        let f = (known.f.len()..p.f.len()).map(|j| with(&|p| p.f[j] = 1.0));
        let lasts = |j: &usize| !matches!(augmented.equation_columns[*j], EquationColumn::Decay { .. });
        let d = (known.d.len()..p.d.len())
            .filter(lasts)
            .map(|j| self.known.weights.applied(&there.design.disturbance(j, &whitener)));
        b.chain(f).chain(d).collect()
    }

    /// Gain in deviance with `A` and `B` solved for, where the augmented model filters.
    fn refitted(&self, augmented: &AugmentedModel, p: &Linear, there: &Moved) -> Option<f64> {
        let fit = &self.known.hypothesis.fit;
        let same_filter = augmented.effect_terms().filter == fit.augmented.effect_terms().filter;
        if same_filter && augmented.noise.ar == fit.augmented.noise.ar
            || self.known.dataset.criterion.simulates()
        {
            return None;
        }
        let whitener = there.design.whitener(&augmented.noise, &p.a);
        let rss = |w: &[Vec<f64>]| energy(&self.known.weights.applied(w));
        let afresh = dynamics_refitted(&there.design, &whitener, p)
            .map(|p| rss(&there.design.innovations(&p, &whitener)));
        let least = afresh.into_iter().chain([rss(&there.innovations)]).filter(|x| *x > 0.0);
        let gain = |x: f64| fit.samples as f64 * (energy(&self.known.weighted) / x).ln();
        least.min_by(f64::total_cmp).map(gain)
    }

    /// The innovations under another augmented model, the other parameters as they are.
    ///
    /// The log slope of a sensor enters as a factor, as it does in the fit.
    fn moved(&self, augmented: &AugmentedModel, p: &Linear, like: &Design) -> Moved {
        let fit = &self.known.hypothesis.fit;
        let design = Design::like(Some(like), self.known.dataset, &fit.grid, augmented);
        let whitener = design.whitener(&augmented.noise, &p.a);
        let mut innovations = design.innovations(p, &whitener);
        let slope = design.log_slope() - self.known.design.log_slope();
        if slope != 0.0 {
            let factor = (-slope / design.samples() as f64).exp();
            innovations.iter_mut().flatten().for_each(|w| *w *= factor);
        }
        Moved { design, innovations }
    }

    /// The weighted difference of innovations.
    fn column(&self, from: &[Vec<f64>], to: &[Vec<f64>], scale: f64) -> Vec<f64> {
        let difference = |(from, to): (&Vec<f64>, &Vec<f64>)| {
            from.iter().zip(to).map(|(x, y)| scale * (y - x)).collect::<Vec<f64>>()
        };
        self.known.weights.applied(&from.iter().zip(to).map(difference).collect::<Vec<_>>())
    }
}

struct Moved {
    design: Design,
    innovations: Vec<Vec<f64>>,
}

/// Mean square; nothing where it is no number, so that such a column counts as none.
fn energy(column: &[f64]) -> f64 {
    let sum = switchback_model::sums::energy(column) / column.len().max(1) as f64;
    if sum.is_finite() { sum } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::model::augmented::{BorderColumn, Clock};
    use crate::testing::{small_dataset, small_model};

    /// The oracle of the score: a fit. Added linear parameters leave the problem nearly linear.
    #[test]
    fn linear_parameters_gain_what_a_fit_says() {
        let (dataset, grid) = small_dataset();
        let start = small_model(&grid);
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        let nominal = fit(context, &|_| AugmentedModel::default(), &[], &start, 30).expect("a fit");
        let hypothesis = Hypothesis::nominal(nominal);
        let known = Known::new(&dataset, &hypothesis);
        let test = known.test().expect("determined");
        let trend = |_: &[f64]| AugmentedModel {
            equation_columns: vec![EquationColumn::Trend { clock: Clock::Record, degree: 1 }],
            ..AugmentedModel::default()
        };
        let since = |_: &[f64]| AugmentedModel {
            border_columns: vec![BorderColumn::ReversalLog { scale: 3.0 }],
            ..AugmentedModel::default()
        };
        let builds: [&Build<'_>; 2] = [&trend, &since];
        for build in builds {
            let start = hypothesis.fit.linear.padded(grid.len(), &build(&[]));
            let fitted = fit(context, build, &[], &start, 30).expect("a fit");
            let gain = hypothesis.fit.deviance - fitted.deviance;
            let score = test.score(build, &[]);
            assert!((score.linear - gain).abs() < 0.15 * gain.max(2.0), "{} {gain}", score.linear);
            assert!(score.refitted.is_none());
        }
    }
}
