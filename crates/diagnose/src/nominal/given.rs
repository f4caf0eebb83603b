//! A model given by the user, in the dataset's dimensionless form.

use switchback_model::linear::is_stable;

use crate::error::DiagnoseError;
use crate::likelihood::design::{Design, Linear, Whitener};
use crate::likelihood::engine::{Fit, FitRecords};
use crate::model::augmented::AugmentedModel;
use crate::model::borders::Grid;
use crate::nominal_model::NominalModel;
use crate::records::dataset::{Dataset, dimensionless};

/// Checks a given model and scales it: `u' = u/s − A(1)·μ/(B(1)·s)` keeps `A y = B u` for `y' = (y − μ)/s`.
pub(crate) fn scaled(dataset: &Dataset, model: &NominalModel) -> Result<Fit, DiagnoseError> {
    let bad = |reason: &str| Err(DiagnoseError::Model { reason: reason.into() });
    if model.a.is_empty() || model.a.len() != model.b.len() {
        return bad("a and b must have the same length, at least 1");
    }
    if model.a.iter().chain(&model.b).any(|x| !x.is_finite()) {
        return bad("a and b must be finite");
    }
    let dc = model.b.iter().sum::<f64>();
    if dc == 0.0 {
        return bad("B(1) is zero, so the borders cannot be distinguished from their level");
    }
    for border in [&model.descending, &model.ascending] {
        if border.len() < 2 || border.windows(2).any(|w| w[1].0 < w[0].0) {
            return bad("each border needs two or more points by increasing v");
        }
        if border.iter().any(|p| !p.0.is_finite() || !p.1.is_finite()) {
            return bad("border points must be finite");
        }
    }
    if !is_stable(&model.a) {
        return bad("A is unstable");
    }
    let level = (1.0 + model.a.iter().sum::<f64>()) * dataset.y_mean / dc;
    let places = |border: &[(f64, f64)]| border.iter().map(|p| p.0).collect::<Vec<f64>>();
    let knots = [&model.descending, &model.ascending]
        .map(|border| dimensionless(&places(border), dataset.v_low, dataset.v_width));
    let values: Vec<f64> = model.descending.iter().chain(&model.ascending).map(|p| p.1).collect();
    let f = dimensionless(&values, level, dataset.y_scale);
    let grid = Grid { knots };
    let linear = Linear { a: model.a.clone(), b: model.b.clone(), f, d: Vec::new() };
    let augmented = AugmentedModel::default();
    let design = Design::new(dataset, &grid, &augmented, |t| t.is_fit());
    let w = design.innovations(&linear, &Whitener::default());
    let samples = design.samples();
    let variance = w.iter().flatten().map(|w| w * w).sum::<f64>() / samples.max(1) as f64;
    Ok(Fit {
        augmented,
        grid,
        linear,
        nonlinear: Vec::new(),
        nonlinear_se: Vec::new(),
        deviance: samples as f64 * variance.max(1e-300).ln(),
        variance,
        power: variance,
        samples,
        parameters: 0.0,
        records: FitRecords::new(dataset, design),
    })
}
