//! Learning the second stage by Newton's method on a convex loss.

use super::table::Table;
use nalgebra::{DMatrix, DVector};
use switchback_diagnose::posterior::{Posterior, SecondStage, softmax};

/// Ridge of the coefficients about those that leave the first stage as it is, in rows.
const RIDGE: f64 = 2.0;
/// Newton steps; the loss is convex and smooth.
const STEPS: usize = 12;

/// Positions of the columns; none where no outcome has fits.
fn layout(table: &Table) -> Option<SecondStage> {
    let at = |name: &str| table.columns.iter().position(|known| known == name).map(|k| k as u16);
    let of = |class: &String| {
        let all: Option<Vec<u16>> = SecondStage::OWN.iter().map(|s| at(&format!("{class}.{s}"))).collect();
        all.unwrap_or_default()
    };
    let own: Vec<Vec<u16>> = table.classes.iter().map(of).collect();
    let common = SecondStage::COMMON.iter().map(|name| at(name)).collect::<Option<Vec<u16>>>()?;
    let mut coefficients = vec![0.0; SecondStage::FEATURES];
    coefficients[0] = 1.0;
    own.iter().any(|own| !own.is_empty()).then_some(SecondStage { coefficients, own, common })
}

/// The second stage of least loss behind first-stage probabilities of the rows, which had not learnt these; none where no outcome has fits.
///
/// ```text
/// minimise Σ w·(ln Σ_j exp(βᵀx_j) − βᵀx_true) + ½·ridge·‖β − e₀‖²
/// ```
pub(super) fn second_stage(table: &Table, p: &[Vec<f64>]) -> Option<SecondStage> {
    let mut stage = layout(table)?;
    let nothing = table.classes.iter().position(|class| class == Posterior::NOTHING);
    let count = SecondStage::FEATURES;
    let features: Vec<DMatrix<f64>> = (0..table.rows())
        .map(|row| {
            let numbers = table.row(row);
            let of = |class: usize| stage.features(&numbers, &p[row], class, Some(class) == nothing);
            let all: Vec<Vec<f64>> = (0..table.classes.len()).map(of).collect();
            DMatrix::from_fn(all.len(), count, |class, k| all[class][k])
        })
        .collect();
    let start = DVector::from_fn(count, |k, _| if k == 0 { 1.0 } else { 0.0 });
    let mut beta = start.clone();
    for _ in 0..STEPS {
        let mut gradient = (&beta - &start) * RIDGE;
        let mut information = DMatrix::identity(count, count) * RIDGE;
        for ((x, label), weight) in features.iter().zip(&table.labels).zip(&table.weights) {
            let p = DVector::from_vec(softmax((x * &beta).as_slice()));
            let mean = x.tr_mul(&p);
            gradient += (&mean - x.row(*label).transpose()) * *weight;
            let weighted = DMatrix::from_fn(x.nrows(), count, |class, k| p[class] * x[(class, k)]);
            information += (x.tr_mul(&weighted) - &mean * mean.transpose()) * *weight;
        }
        let step = information.cholesky()?.solve(&gradient);
        // Half a step at most is taken of what is far: Newton's steps of a logit overshoot from afar.
        let longest = step.amax();
        beta -= &step * if longest > 2.0 { 2.0 / longest } else { 1.0 };
    }
    stage.coefficients = beta.iter().map(|b| *b as f32).collect();
    Some(stage)
}

/// Parts between which the second stage is validated.
const PARTS: usize = 5;

/// Probabilities of each row by a second stage that had not learnt it.
pub(super) fn validated(table: &Table, p: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let nothing = table.classes.iter().position(|class| class == Posterior::NOTHING);
    let mut out = p.to_vec();
    for part in 0..PARTS {
        let learnt: Vec<usize> =
            (0..table.rows()).filter(|row| row % PARTS != part && table.is_known(*row)).collect();
        let of_learnt: Vec<Vec<f64>> = learnt.iter().map(|row| p[*row].clone()).collect();
        let Some(stage) = second_stage(&table.of_rows(&learnt), &of_learnt) else { continue };
        for row in (part..table.rows()).step_by(PARTS) {
            out[row] = stage.probabilities(&table.row(row), &p[row], nothing);
        }
    }
    out
}
