//! From an augmented model and the records to residuals and their derivatives.
//!
//! ```text
//! e(t) = x(t) + Σ aᵢ x(t−i) − Σ b̃ⱼ ũ(t−j) − Σ d ψ(t),   ũ = u / den,   b̃ = b ∗ taps,   u = rows · f
//! w(t) = s(t)·[e(t) + Σ dᵢ e(t−i)] − Σ cᵢ w(t−i)
//! ```
//!
//! `x` is the sensor's characteristic undone, `w` the innovation. Everything is linear given the effects' nonlinear parameters,
//! but for the product of `b` and `f`.

use std::sync::Arc;

use crate::likelihood::mask::{Mask, masked};
use crate::likelihood::rows::{EquationColumns, Rows, equation_columns, rows, sensitivity_rows};
use crate::model::augmented::{AugmentedModel, EquationColumn, LEAST_VARIANCE, NoiseLaw, convolve};
use crate::model::borders::Grid;
use crate::model::effect_terms::{EffectTerms, Positions};
use crate::model::sensor::SensorCurve;
use crate::records::dataset::{Criterion, Dataset, ScaledRecord, WARM_UP};
use crate::records::motion::{Motion, motions};
use crate::records::passes::Passes;
use crate::records::signal::Signal;

pub(crate) use crate::likelihood::jacobian::filtered_rows;
use crate::likelihood::whitener::add_lagged;
pub(crate) use crate::likelihood::whitener::{LEAD, Whitener};
pub(crate) use crate::model::linear::Linear;

/// One record as the fit sees it. Its parts are shared among designs that differ elsewhere.
#[derive(Debug, Clone)]
pub(crate) struct DesignScaled {
    /// How the input moves, behind the play.
    pub(crate) moves: Arc<[Motion]>,
    pub(crate) rows: Arc<Rows>,
    pub(crate) columns: Arc<EquationColumns>,
    /// The output with the sensor's characteristic undone.
    pub(crate) x: Signal,
    /// `ln dx/dy`, summed over the counted samples.
    pub(crate) log_slope: f64,
    /// First counted sample.
    pub(crate) from: usize,
    /// Change of `u` per change of `v` while moving and while resting, where input noise is modelled.
    pub(crate) sensitivity: Option<Arc<[Rows; 2]>>,
    /// Samples that have no say.
    pub(crate) mask: Mask,
}

/// Errors that are known where those before them are not.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct InnovationShare {
    count: usize,
    energy: f64,
}

impl InnovationShare {
    /// The deviance of `n` samples with these among them; `forecast` is that of the others, stretched to all `n`.
    pub(crate) fn among(self, n: f64, forecast: f64) -> f64 {
        if self.count == 0 {
            return forecast;
        }
        let count = self.count as f64;
        forecast * (1.0 - count / n) + count * (self.energy / count).max(LEAST_VARIANCE).ln()
    }
}

/// The chosen records under an augmented model.
#[derive(Debug, Clone)]
pub(crate) struct Design {
    pub(crate) scaled_records: Vec<DesignScaled>,
    pub(crate) taps: Vec<f64>,
    /// Denominator beyond its leading one.
    pub(crate) poles: Vec<f64>,
    pub(crate) criterion: Criterion,
    /// What it was built from.
    pub(crate) grid: Grid,
    pub(crate) augmented: AugmentedModel,
    passes: Passes,
}

impl Design {
    /// A design of no records: what is [like](Self::like) it is built from the beginning.
    pub(crate) fn of_nothing(dataset: &Dataset) -> Self {
        Self::new(dataset, &Grid { knots: [Vec::new(), Vec::new()] }, &AugmentedModel::default(), |_| false)
    }

    /// Whether it is the design of a grid and an augmented model.
    pub(super) fn serves(&self, grid: &Grid, augmented: &AugmentedModel) -> bool {
        !self.scaled_records.is_empty() && self.grid == *grid && self.augmented.same_design(augmented)
    }

    /// Builds the design of the records that `chosen` picks.
    pub(crate) fn new(
        dataset: &Dataset,
        grid: &Grid,
        augmented: &AugmentedModel,
        chosen: impl Fn(&ScaledRecord) -> bool,
    ) -> Self {
        let numbered: Vec<(usize, &ScaledRecord)> =
            dataset.scaled_records.iter().enumerate().filter(|(_, t)| chosen(t)).collect();
        Self::of(dataset, grid, augmented, &numbered)
    }

    /// The design of the fit records; what a design of the same records has in common with it is shared. Borders that are known lie where
    /// the augmented model's play has moved them to.
    pub(crate) fn like(
        known: Option<&Self>,
        dataset: &Dataset,
        grid: &Grid,
        augmented: &AugmentedModel,
    ) -> Self {
        let grid = &*dataset.placed(grid, augmented.play);
        let numbered: Vec<(usize, &ScaledRecord)> =
            dataset.scaled_records.iter().enumerate().filter(|(_, t)| t.is_fit()).collect();
        let known =
            known.filter(|k| k.criterion == dataset.criterion && k.scaled_records.len() == numbered.len());
        let common = known.map_or(Common::default(), |k| Common::between(k, grid, augmented));
        Self::sharing(known.map(|k| (k, common)), dataset, (grid, augmented), &numbered)
    }

    /// Builds the design of records given with their numbers in the dataset.
    pub(crate) fn of(
        dataset: &Dataset,
        grid: &Grid,
        augmented: &AugmentedModel,
        scaled_records: &[(usize, &ScaledRecord)],
    ) -> Self {
        let grid = &*dataset.placed(grid, augmented.play);
        Self::sharing(None, dataset, (grid, augmented), scaled_records)
    }

    fn sharing(
        known: Option<(&Self, Common)>,
        dataset: &Dataset,
        (grid, augmented): (&Grid, &AugmentedModel),
        scaled_records: &[(usize, &ScaledRecord)],
    ) -> Self {
        // B has its coefficients beyond the order in `Linear::padded`, the limits of the sensor are in the mask.
        let EffectTerms { extra_b: _, positions, operator, filter, columns: _, curve, saturation: _, noise } =
            augmented.effect_terms();
        let Positions { late, play } = positions;
        dataset.passes.count();
        let scaled_records = scaled_records
            .iter()
            .enumerate()
            .map(|(k, &(number, scaled))| {
                let moved = (late > 0.0).then(|| scaled.late(late, dataset.rule));
                let scaled = moved.as_ref().unwrap_or(scaled);
                // The same record of the known design, where a part of it serves.
                let same = |effect_term: fn(&Common) -> bool| {
                    known
                        .filter(|(_, common)| effect_term(common))
                        .map(|(design, _)| &design.scaled_records[k])
                };
                let (x, log_slope) = match same(|c| c.output) {
                    Some(t) => (t.x.clone(), t.log_slope),
                    None => undo_sensor(scaled, curve),
                };
                let moves = match same(|c| c.moves) {
                    Some(t) => Arc::clone(&t.moves),
                    None if play.is_none() => Arc::clone(&scaled.moves),
                    None => motions(&scaled.v, play, dataset.rule).into(),
                };
                let sensitive = noise.input.is_some();
                let mask = match same(|c| c.masked) {
                    Some(t) => t.mask.clone(),
                    None => masked(scaled, augmented, dataset.rule),
                };
                DesignScaled {
                    rows: same(|c| c.rows).map_or_else(
                        || rows((dataset, number, scaled), &moves, grid, &operator).into(),
                        |t| Arc::clone(&t.rows),
                    ),
                    moves,
                    columns: same(|c| c.columns).map_or_else(
                        || equation_columns(dataset, (number, scaled), augmented).into(),
                        |t| Arc::clone(&t.columns),
                    ),
                    x,
                    log_slope,
                    from: scaled.from,
                    sensitivity: sensitive.then(|| {
                        same(|c| c.sensitivity)
                            .and_then(|t| t.sensitivity.clone())
                            .unwrap_or_else(|| sensitivity_rows(scaled, grid, operator.jitter).into())
                    }),
                    mask,
                }
            })
            .collect();
        Self {
            scaled_records,
            taps: filter.taps(),
            poles: filter.poles().to_vec(),
            criterion: dataset.criterion,
            grid: grid.clone(),
            augmented: augmented.clone(),
            passes: dataset.passes.clone(),
        }
    }

    /// The filter from equation errors to what is counted: innovations, or the errors `e/A` of the simulation from the
    /// measured state [`LEAD`] samples before the first counted one.
    pub(crate) fn whitener(&self, law: &NoiseLaw, a: &[f64]) -> Whitener {
        match self.criterion {
            Criterion::OneStep => Whitener::new(law, a),
            Criterion::Simulation { .. } => Whitener { ar: Vec::new(), ma: a.to_vec() },
        }
    }

    /// A pass over the samples begins.
    pub(crate) fn pass_begins(&self) {
        self.passes.count();
    }

    /// Samples counted.
    pub(crate) fn samples(&self) -> usize {
        self.scaled_records.iter().map(|t| t.x.len() - t.from).sum()
    }

    /// Sum of `ln dx/dy` over the counted samples.
    pub(crate) fn log_slope(&self) -> f64 {
        self.scaled_records.iter().map(|t| t.log_slope).sum()
    }

    /// `ũ` of one record.
    pub(crate) fn input(&self, scaled: &DesignScaled, f: &[f64]) -> Vec<f64> {
        let mut u = scaled.rows.times(f);
        if !self.poles.is_empty() {
            let rest = 1.0 / (1.0 + self.poles.iter().sum::<f64>());
            let before = u[0] * rest;
            for t in 0..u.len() {
                for (k, p) in self.poles.iter().enumerate() {
                    let past = if t > k { u[t - k - 1] } else { before };
                    u[t] -= p * past;
                }
            }
        }
        u
    }

    /// Equation errors `e(t)` of one record from sample `from − LEAD`.
    pub(crate) fn errors(&self, scaled: &DesignScaled, p: &Linear) -> Vec<f64> {
        self.errors_from(scaled, p, scaled.from.saturating_sub(LEAD))
    }

    /// Equation errors `e(t)` of one record from a sample that has a past.
    pub(crate) fn errors_from(&self, scaled: &DesignScaled, p: &Linear, first: usize) -> Vec<f64> {
        let u = self.input(scaled, &p.f);
        let b = convolve(&p.b, &self.taps);
        let mut e = scaled.x[first..].to_vec();
        for (i, a) in p.a.iter().enumerate() {
            add_lagged(&mut e, &scaled.x, first, (i + 1, *a));
        }
        for (j, b) in b.iter().enumerate() {
            add_lagged(&mut e, &u, first, (j + 1, -b));
        }
        let d = scaled.columns.coefficients(&p.d);
        if !d.is_empty() {
            for (t, e) in e.iter_mut().enumerate() {
                *e -= d.iter().zip(scaled.columns.row(first + t)).map(|(d, psi)| d * psi).sum::<f64>();
            }
        }
        e
    }

    /// The derivative of the innovations with respect to the coefficient of an equation column.
    pub(crate) fn disturbance(&self, column: usize, whitener: &Whitener) -> Vec<Vec<f64>> {
        let of_scaled = |scaled: &DesignScaled| {
            let Some(at) = scaled.columns.numbers.iter().position(|&j| j == column) else {
                return vec![0.0; scaled.x.len() - scaled.from];
            };
            let first = scaled.from.saturating_sub(LEAD);
            let e = (first..scaled.x.len()).map(|t| -scaled.columns.row(t)[at]);
            let mut w = whitener.apply(e.collect());
            w.drain(..(scaled.from - first).min(w.len()));
            w
        };
        self.scaled_records.iter().map(of_scaled).collect()
    }

    /// Innovations of every record on the counted samples, before weighting.
    pub(crate) fn innovations(&self, p: &Linear, whitener: &Whitener) -> Vec<Vec<f64>> {
        self.whitened(self.all_errors(p), whitener)
    }

    /// The same, nothing where a sample has no say.
    pub(crate) fn counted_innovations(&self, p: &Linear, whitener: &Whitener) -> Vec<Vec<f64>> {
        let mut all = self.innovations(p, whitener);
        for (scaled, w) in self.scaled_records.iter().zip(&mut all) {
            let masked = scaled.mask.out.iter().flat_map(|masked| masked.iter());
            w.iter_mut().zip(masked).filter(|(_, masked)| **masked).for_each(|(w, _)| *w = 0.0);
        }
        all
    }

    /// The errors, from sample `from − LEAD` of every record, that nothing predicts.
    pub(crate) fn innovation_share(&self, errors: &[Vec<f64>]) -> InnovationShare {
        let whitens = self.criterion == Criterion::OneStep;
        let mut out = InnovationShare::default();
        for (scaled, e) in self.scaled_records.iter().zip(errors).filter(|_| whitens) {
            let lead = scaled.from - scaled.from.saturating_sub(LEAD);
            out.count += scaled.mask.innovation_share.len();
            out.energy += scaled.mask.innovation_share.iter().map(|k| e[lead + k].powi(2)).sum::<f64>();
        }
        out
    }

    /// Equation errors of every record.
    pub(crate) fn all_errors(&self, p: &Linear) -> Vec<Vec<f64>> {
        self.passes.count();
        self.scaled_records.iter().map(|scaled| self.errors(scaled, p)).collect()
    }

    /// Innovations from the equation errors of every record.
    pub(crate) fn whitened(&self, errors: Vec<Vec<f64>>, whitener: &Whitener) -> Vec<Vec<f64>> {
        let of_scaled = |(scaled, e): (&DesignScaled, Vec<f64>)| {
            let mut w = whitener.apply(e);
            let skip = scaled.from - scaled.from.saturating_sub(LEAD);
            w.drain(..skip.min(w.len()));
            w
        };
        self.scaled_records.iter().zip(errors).map(of_scaled).collect()
    }
}

const _: () = assert!(LEAD < WARM_UP);

/// `x` of one record and its summed log slope.
fn undo_sensor(scaled: &ScaledRecord, curve: &SensorCurve) -> (Signal, f64) {
    if curve.is_straight() {
        return (scaled.y.clone(), 0.0);
    }
    let mut log_slope = 0.0;
    let x = scaled
        .y
        .iter()
        .enumerate()
        .map(|(t, &y)| {
            let (x, slope) = curve.undo(y);
            if t >= scaled.from {
                // A characteristic that folds back is no sensor: the floor makes it expensive, not undefined.
                log_slope += slope.max(1e-3).ln();
            }
            x
        })
        .collect();
    (x, log_slope)
}

/// Which parts of a design serve another augmented model or grid unchanged.
#[derive(Debug, Clone, Copy, Default)]
struct Common {
    moves: bool,
    rows: bool,
    columns: bool,
    output: bool,
    sensitivity: bool,
    masked: bool,
}

impl Common {
    fn between(known: &Design, grid: &Grid, augmented: &AugmentedModel) -> Self {
        let had = known.augmented.effect_terms();
        // B and the filter are no part of a record, the law of the noise is none but for what follows.
        let EffectTerms { extra_b: _, positions, operator, filter: _, columns, curve, saturation, noise } =
            augmented.effect_terms();
        let moves = had.positions == positions;
        let same_grid = known.grid == *grid;
        Self {
            moves,
            rows: moves && same_grid && had.operator == operator,
            columns: had.columns == columns
                && (had.operator.gain == operator.gain || !columns.contains(&EquationColumn::Gain)),
            output: had.curve == curve,
            sensitivity: moves && same_grid && had.operator.jitter == operator.jitter,
            masked: moves
                && had.saturation == saturation
                && (saturation.is_none() || had.noise.reach() == noise.reach()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nothing_foretells_counts_by_itself() {
        let white = 1000.0 * 0.25_f64.ln();
        // As large as the others: as if it were predicted.
        let alike = InnovationShare { count: 40, energy: 40.0 * 0.25 };
        assert!((alike.among(1000.0, white) - white).abs() < 1e-9);
        // What a filter gained on the rest is not gained here.
        let larger = InnovationShare { count: 40, energy: 40.0 };
        assert!((larger.among(1000.0, white) - 960.0 * 0.25_f64.ln()).abs() < 1e-9);
    }
}
