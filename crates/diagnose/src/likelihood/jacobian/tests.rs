//! The Jacobian against differences, and its sparse rows against the dense ones.

use super::*;
use crate::model::augmented::{
    AugmentedModel, BorderColumn, Clock, EquationColumn, Resting, Transition, TransitionLaw,
};
use crate::records::dataset::{Criterion, ScaledRecord};
use crate::testing::{small_dataset, small_model};

/// Central differences of half the sum of squares.
fn gradient_is_the_slope(normal: &Normal, p: &Linear, half_sum: impl Fn(&Linear) -> f64) {
    for i in 0..p.len() {
        let mut by = vec![0.0; p.len()];
        by[i] = 1.0;
        let h = 1e-5;
        let slope = (half_sum(&p.moved(&by, h)) - half_sum(&p.moved(&by, -h))) / (2.0 * h);
        let scale = normal.entry(i, i).max(1.0);
        assert!((slope - normal.gradient[i]).abs() < 1e-6 * scale, "{i}: {slope} {}", normal.gradient[i]);
    }
}

/// The oracle of the Jacobian under one step.
fn check(augmented: &AugmentedModel, p: &Linear) {
    let (dataset, grid) = small_dataset();
    let design = Design::new(&dataset, &grid, augmented, ScaledRecord::is_fit);
    // Without output noise the whitening filter does not depend on the parameters.
    let whitener = Whitener::new(&augmented.noise, &p.a);
    let half_sum =
        |p: &Linear| 0.5 * design.innovations(p, &whitener).iter().flatten().map(|w| w * w).sum::<f64>();
    let innovations = design.innovations(p, &whitener).concat();
    let normal = normal_equations(&design, p, &whitener, &Weights::default(), (&innovations, &[]));
    gradient_is_the_slope(&normal, p, half_sum);
}

#[test]
fn the_jacobian_of_a_simulation_agrees_with_differences() {
    let (dataset, grid) = small_dataset();
    let dataset = dataset.judged_by(Criterion::Simulation { share: 1.0 });
    let p = Linear { a: vec![-0.9, 0.3], ..small_model(&grid) };
    let design = Design::new(&dataset, &grid, &AugmentedModel::default(), ScaledRecord::is_fit);
    // Here the filter 1/A moves with the parameters.
    let errors = |p: &Linear| {
        let whitener = design.whitener(&AugmentedModel::default().noise, &p.a);
        design.innovations(p, &whitener).concat()
    };
    let half_sum = |p: &Linear| 0.5 * errors(p).iter().map(|w| w * w).sum::<f64>();
    let whitener = design.whitener(&AugmentedModel::default().noise, &p.a);
    let normal = normal_equations(&design, &p, &whitener, &Weights::default(), (&errors(&p), &[]));
    gradient_is_the_slope(&normal, &p, half_sum);
}

/// The oracle of the sparse rows: the dense ones.
fn same_as_dense(augmented: &AugmentedModel, p: &Linear) {
    let (dataset, grid) = small_dataset();
    let design = Design::new(&dataset, &grid, augmented, ScaledRecord::is_fit);
    let whitener = Whitener::new(&augmented.noise, &p.a);
    let factors = |t: &DesignScaled| (t.from..t.x.len()).map(|t| 0.5 + 0.1 * (t % 7) as f64).collect();
    let scale: Vec<Vec<f64>> = design.scaled_records.iter().map(factors).collect();
    let weights = Weights { scale: Some(scale), ..Weights::default() };
    let w = design.innovations(p, &whitener).concat();
    let sparse = Jacobian::new(&design, p, &whitener, &weights).normal(&w);
    let mut rows = Vec::new();
    for (number, scaled) in design.scaled_records.iter().enumerate() {
        let active = Active::on(scaled, p);
        let parameters = active.parameters(p);
        let mut weigh = weights.rows(number, parameters.len());
        dense_rows((&design, scaled), p, &whitener, &active, |row| {
            weigh(row);
            let mut whole = vec![0.0; p.len()];
            parameters.iter().zip(row).for_each(|(&i, x)| whole[i] = *x);
            rows.extend(whole);
        });
    }
    let dense = Jacobian { columns: p.len(), store: Store::Dense(rows) }.normal(&w);
    for i in 0..p.len() {
        assert!((sparse.gradient[i] - dense.gradient[i]).abs() < 1e-10);
        for j in i..p.len() {
            assert!((sparse.entry(i, j) - dense.entry(i, j)).abs() < 1e-10, "{i} {j}");
        }
    }
}

#[test]
fn further_columns_are_appended() {
    let (dataset, grid) = small_dataset();
    let p = small_model(&grid);
    for pole in [None, Some(0.5)] {
        let mut augmented = AugmentedModel::default();
        pole.iter().for_each(|p: &f64| augmented.filter(&[1.0 - p], &[1.0, -p]));
        let design = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        let whitener = Whitener::default();
        let w = design.innovations(&p, &whitener).concat();
        let extra: Vec<f64> = (0..w.len()).map(|t| (t as f64 * 0.9).cos()).collect();
        let jacobian = Jacobian::new(&design, &p, &whitener, &Weights::default());
        let (alone, cross) = (jacobian.normal(&w), jacobian.cross(0, &extra));
        let both = normal_equations(&design, &p, &whitener, &Weights::default(), (&w, &[extra]));
        for (i, x) in cross.iter().enumerate() {
            assert!((both.entry(i, p.len()) - x).abs() < 1e-10);
            assert!((both.gradient[i] - alone.gradient[i]).abs() < 1e-10);
            assert!((both.entry(i, i) - alone.entry(i, i)).abs() < 1e-10);
        }
    }
}

#[test]
fn the_jacobian_agrees_with_differences() {
    let (_, grid) = small_dataset();
    let plain = small_model(&grid);
    check(&AugmentedModel::default(), &plain);

    let mut augmented = AugmentedModel {
        delay: 1.4,
        transition: Some(Transition { length: 0.1, shape: 1.2, law: TransitionLaw::Offset }),
        border_columns: vec![BorderColumn::Speed { power: 1.0, scale: 0.1, while_resting: Resting::Held }],
        equation_columns: vec![EquationColumn::Trend { clock: Clock::Record, degree: 1 }],
        ..AugmentedModel::default()
    };
    augmented.noise.ar = vec![0.3, -0.2];
    let mut rich = plain;
    rich.f.push(0.3);
    rich.d.push(0.1);
    check(&augmented, &rich);
    same_as_dense(&augmented, &rich);

    // Longer than what is known before the first counted sample.
    let short = std::mem::replace(&mut augmented.noise.ar, (1..=9).map(|k| 0.4 / f64::from(k)).collect());
    check(&augmented, &rich);
    same_as_dense(&augmented, &rich);
    augmented.noise.ar = short;

    augmented.filter(&[0.5], &[1.0, -0.5]);
    augmented.noise.ma = vec![-0.4];
    check(&augmented, &rich);
}
