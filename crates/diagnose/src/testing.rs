//! Small records for tests.

use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

use crate::likelihood::design::Design;
use crate::model::augmented::{AugmentedModel, convolve};
use crate::model::borders::Grid;
use crate::model::linear::Linear;
use crate::records::dataset::Dataset;

/// A short free record with rests and reversals of many sizes, and a grid with a jump.
pub(crate) fn small_dataset() -> (Dataset, Grid) {
    let v: Vec<f64> = (0..240)
        .map(|t| {
            let t = if t % 40 > 33 { t - t % 40 + 33 } else { t } as f64;
            0.5 + 0.3 * (0.21 * t).sin() + 0.2 * (0.057 * t).sin()
        })
        .collect();
    let y: Vec<f64> = (0..240).map(|t| (t as f64 * 0.3).sin() + 0.2 * (t as f64 * 1.7).cos()).collect();
    let rig = Rig {
        name: "small".into(),
        sample_time: 1.0,
        order: Some(2),
        interval: None,
        input_label: "v".into(),
        output_label: "y".into(),
        records: vec![RigRecord {
            name: "free".into(),
            role: Role::Free,
            usage: Usage::Fit,
            record: Record::new(v, y).expect("finite and equally long"),
            predicted: None,
        }],
    };
    let dataset = Dataset::new(&rig).expect("a usable rig");
    (dataset, Grid { knots: [vec![0.0, 0.4, 1.0], vec![0.0, 0.5, 0.5, 1.0]] })
}

/// A model of second order on a grid.
pub(crate) fn small_model(grid: &Grid) -> Linear {
    let f = (0..grid.len()).map(|i| (i as f64 * 0.7).sin()).collect();
    Linear { a: vec![-0.6, 0.2], b: vec![0.8, 0.3], f, d: Vec::new() }
}

/// The same input, the output that of a model without noise.
pub(crate) fn noise_free(
    mut dataset: Dataset,
    grid: &Grid,
    augmented: &AugmentedModel,
    truth: &Linear,
) -> Dataset {
    let design = Design::new(&dataset, grid, augmented, |t| t.is_fit());
    let effect_term = &design.scaled_records[0];
    let u = design.input(effect_term, &truth.f);
    let (b, d) = (convolve(&truth.b, &design.taps), effect_term.columns.coefficients(&truth.d));
    let mut y: Vec<f64> = Vec::with_capacity(u.len());
    for t in 0..u.len() {
        let past = |x: &[f64], lag: usize| if t > lag { x[t - 1 - lag] } else { 0.0 };
        let old: f64 = truth.a.iter().enumerate().map(|(i, a)| a * past(&y, i)).sum();
        let new: f64 = b.iter().enumerate().map(|(i, b)| b * past(&u, i)).sum();
        let beside: f64 = d.iter().zip(effect_term.columns.row(t)).map(|(d, psi)| d * psi).sum();
        y.push(new + beside - old);
    }
    dataset.scaled_records[0].y = y.into();
    dataset
}

/// White noise of variance one, the same at every call.
pub(crate) fn white() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * 12.0_f64.sqrt()
    }
}
