//! The fast paths against slow and obvious ones.

use super::basis::Basis;
use super::cells::Cells;
use super::equation_error::{Moments, fill_row};
use super::limit::Limit;
use super::one_shot::{Grid, one_shot};
use super::problem::{Parameters, Segment, Structure};
use super::rank_one::over_parameterised;
use super::regression::Regression;
use super::simulation_error::{each_batch, free_run, linearise_whitened, whitened_cost};
use crate::Estimate;
use crate::excitation::RandomLevels;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use switchback_model::hysteresis::{Interval, SwitchedHysteresis, Table, TablePoint};
use switchback_model::linear::{filter, is_stable};
use switchback_model::record::Record;
use switchback_model::reversal::{Branches, ReversalRule, Timing};

fn uniform(rng: &mut ChaCha8Rng, count: usize) -> Vec<f64> {
    (0..count).map(|_| rng.random_range(-1.0..1.0)).collect()
}

/// Random input and output with the hats of two borders of three knots.
fn random_data(seed: u64, timing: Timing) -> (Vec<f64>, Basis, Cells, usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (v, y) = (uniform(&mut rng, 200), uniform(&mut rng, 200));
    let basis = Basis::borders(vec![-1.0, 0.2, 1.0], vec![-1.0, -0.3, 1.0]);
    let branches = Branches::of(&v, ReversalRule { timing, ..ReversalRule::EXACT }).unwrap();
    let cells = Cells::of(&basis, &v, &branches);
    (y, basis, cells, branches.first_known())
}

fn structures() -> impl Strategy<Value = Structure> {
    (1usize..4, -3isize..3).prop_map(|(order, delay)| Structure { order, delay })
}

fn timings() -> impl Strategy<Value = Timing> {
    prop_oneof![Just(Timing::AtSamples), Just(Timing::BetweenSamples)]
}

proptest! {
    #[test]
    fn moments_give_the_least_squares_of_a_dense_qr(seed: u64, structure in structures(), timing in timings()) {
        let (y, basis, cells, known) = random_data(seed, timing);
        let segment = Segment::usable(structure, &y, &cells, known..y.len()).unwrap();
        let moments = Moments::of(structure, basis.features(), &[segment]);
        let p = moments.constant() + 1;
        let (mut design, mut output) = (DMatrix::zeros(segment.len(), p), DVector::zeros(segment.len()));
        let mut row = Vec::new();
        for t in segment.from..segment.to {
            fill_row(structure, basis.features(), &segment, t, &mut row);
            for &(column, x) in &row {
                if column < p { design[(t - segment.from, column)] += x } else { output[t - segment.from] = x }
            }
        }
        let qr = design.qr();
        let dense = qr.r().solve_upper_triangular(&(qr.q().transpose() * output)).unwrap();
        let fast = over_parameterised(&moments).unwrap();
        prop_assert!((fast - dense).amax() < 1e-9);
    }

    #[test]
    fn the_linearised_free_run_has_the_derivatives_of_finite_differences(
        seed: u64, structure in structures(), timing in timings(),
    ) {
        let (y, basis, cells, known) = random_data(seed, timing);
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 1);
        let small = |x: Vec<f64>| x.into_iter().map(|x| 0.3 * x).collect::<Vec<f64>>();
        let theta = Parameters {
            a: small(uniform(&mut rng, structure.order)),
            b: uniform(&mut rng, structure.numerator()),
            f: uniform(&mut rng, basis.features()),
            c: 0.3,
        };
        let segment = Segment::usable(structure, &y, &cells, known..y.len()).unwrap();
        let p = theta.a.len() + theta.b.len() + theta.f.len() + 1;
        let run = |i: usize, h: f64| {
            let mut step = vec![0.0; p];
            step[i] = h;
            DVector::from_vec(free_run(structure, &theta.moved(&step), &segment))
        };
        let jacobian: Vec<DVector<f64>> = (0..p).map(|i| (run(i, 1e-6) - run(i, -1e-6)) / 2e-6).collect();
        let error = DVector::from_column_slice(&y[segment.from..segment.to]) - run(0, 0.0);
        let fast = linearise_whitened(structure, &theta, &[segment], &[]);
        for i in 0..p {
            let scale = 1.0 + jacobian[i].norm_squared();
            prop_assert!((fast.gradient[i] - jacobian[i].dot(&error)).abs() < 1e-6 * scale * (1.0 + error.norm()));
            for j in 0..p {
                let dense = jacobian[i].dot(&jacobian[j]);
                prop_assert!((fast.information[(i, j)] - dense).abs() < 1e-6 * scale * (1.0 + jacobian[j].norm()));
            }
        }
        let batched = fast.batches.iter().fold(DVector::zeros(p), |sum, g| sum + g);
        prop_assert!((batched - fast.gradient).amax() < 1e-9);
    }

    /// With `e = w/D` from rest, `e = Ψw` with the impulse response of `1/D` along the rows of `Ψ`: generalised least squares weighs by `(ΨΨᵀ)⁻¹`.
    #[test]
    fn filtered_errors_are_weighed_by_the_inverse_covariance_of_the_noise(
        seed: u64, structure in structures(), d1 in -0.9f64..0.9, d2 in -0.9f64..0.9,
    ) {
        let (y, basis, cells, known) = random_data(seed, Timing::AtSamples);
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 2);
        let theta = Parameters {
            a: uniform(&mut rng, structure.order).into_iter().map(|x| 0.3 * x).collect(),
            b: uniform(&mut rng, structure.numerator()),
            f: uniform(&mut rng, basis.features()),
            c: -0.2,
        };
        let segment = Segment::usable(structure, &y, &cells, known..y.len()).unwrap();
        // Reflection coefficients below one make a stable 1/D.
        let whitening = [d1 * (1.0 + d2), d2];
        let mut pulse = vec![0.0; segment.len()];
        pulse[0] = 1.0;
        let response = filter(&whitening, &[0.0], &vec![0.0; pulse.len()], &pulse, 0.0, 0.0);
        let psi = DMatrix::from_fn(pulse.len(), pulse.len(), |i, j| if i < j { 0.0 } else { response[i - j] });
        let weight = (&psi * psi.transpose()).cholesky().unwrap().inverse();
        let p = theta.a.len() + theta.b.len() + theta.f.len() + 1;
        let (mut jacobian, mut error) = (DMatrix::zeros(p, segment.len()), DVector::zeros(segment.len()));
        each_batch(structure, &theta, &segment, &[], |t, (columns, first), errors| {
            let batch = columns.view(first, errors.len());
            jacobian.columns_mut(t - segment.from, errors.len()).copy_from(&batch);
            error.rows_mut(t - segment.from, errors.len()).copy_from(errors);
        });
        let fast = linearise_whitened(structure, &theta, &[segment], &whitening);
        let dense = &jacobian * &weight * jacobian.transpose();
        prop_assert!((fast.information - &dense).amax() < 1e-8 * (1.0 + dense.amax()));
        let gradient = &jacobian * &weight * &error;
        prop_assert!((fast.gradient - &gradient).amax() < 1e-8 * (1.0 + gradient.amax()));
        let cost = error.dot(&(&weight * &error));
        prop_assert!((whitened_cost(structure, &theta, &[segment], &whitening) - cost).abs() < 1e-8 * (1.0 + cost));
    }

    /// The oracle: weights of zero and one.
    #[test]
    fn errors_before_the_counted_ones_have_no_weight(seed: u64, structure in structures(), run_in in 0usize..190) {
        let (y, basis, cells, known) = random_data(seed, Timing::AtSamples);
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 3);
        let theta = Parameters {
            a: uniform(&mut rng, structure.order).into_iter().map(|x| 0.3 * x).collect(),
            b: uniform(&mut rng, structure.numerator()),
            f: uniform(&mut rng, basis.features()),
            c: 0.1,
        };
        let whole = Segment::usable(structure, &y, &cells, known..y.len()).unwrap();
        let Some(segment) = whole.counted_from(run_in) else { return Ok(()) };
        let weights: Vec<f64> = (0..y.len()).map(|t| f64::from(u8::from(t >= run_in))).collect();
        let weighted = Segment { weights: Some(&weights), ..whole };
        let [fast, slow] = [segment, weighted].map(|s| linearise_whitened(structure, &theta, &[s], &[0.4]));
        prop_assert!((&fast.information - &slow.information).amax() < 1e-9 * (1.0 + slow.information.amax()));
        prop_assert!((&fast.gradient - &slow.gradient).amax() < 1e-9 * (1.0 + slow.gradient.amax()));
        let costs = [segment, weighted].map(|s| whitened_cost(structure, &theta, &[s], &[0.4]));
        prop_assert!((costs[0] - costs[1]).abs() < 1e-9 * (1.0 + costs[1]));
    }

    #[test]
    fn stability_agrees_with_the_roots(roots in prop::collection::vec(-1.5f64..1.5, 1..5)) {
        prop_assume!(roots.iter().all(|r| (r.abs() - 1.0).abs() > 1e-3));
        let mut a = vec![1.0];
        for r in &roots {
            a.push(0.0);
            for i in (1..a.len()).rev() { a[i] -= r * a[i - 1] }
        }
        prop_assert_eq!(is_stable(&a[1..]), roots.iter().all(|r| r.abs() < 1.0));
    }

    #[test]
    fn hats_add_up_to_one_and_interpolate(v in -2.0f64..2.0, values in prop::collection::vec(-5.0f64..5.0, 5)) {
        let basis = Basis::borders(vec![-1.0, 0.2, 1.0], vec![-1.0, -0.3, 1.0]);
        let cell = |branch| super::basis::Cell { main: basis.place(branch, v), next: None };
        for (branch, first) in [(switchback_model::hysteresis::Branch::Descending, 0), (switchback_model::hysteresis::Branch::Ascending, 3)] {
            let flat = cell(branch).value(&[1.0; 5]);
            prop_assert!(first == 0 || (flat - 1.0).abs() < 1e-12);
            let sum: f64 = cell(branch).features().map(|(k, x)| x * values[k]).sum();
            prop_assert!((sum - cell(branch).value(&values)).abs() < 1e-12);
        }
    }
}

/// A record of a switched system on a grid, and everything needed to identify it.
struct Synthetic {
    v: Vec<f64>,
    z: Vec<f64>,
    e: Vec<f64>,
    grid: Grid,
}

fn synthetic(seed: u64, samples: usize) -> Synthetic {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let drive = RandomLevels::new(Interval::new(-1.0, 1.0).unwrap());
    let v = drive.record_input(samples, &mut rng);
    let table = |u: [f64; 3]| [-1.0, 0.0, 1.0].into_iter().zip(u).map(|(v, u)| TablePoint { v, u }).collect();
    let borders = Table::new(table([-0.4, 0.6, 0.9]), table([-0.8, -0.5, 0.7])).unwrap();
    let hysteresis = SwitchedHysteresis::new(drive.interval(), Box::new(borders)).unwrap();
    let u = hysteresis.output(&v, hysteresis.u_low());
    let z = filter(&[-1.1, 0.4], &[0.5, 0.3], &u, &[], 0.0, 0.0);
    let w = uniform(&mut rng, v.len());
    let e = filter(&[-1.1, 0.4], &[], &u, &w, 0.0, 0.0);
    let grid = Grid {
        structure: Structure { order: 2, delay: 0 },
        basis: Basis::borders(vec![-1.0, 0.0, 1.0], vec![-1.0, 0.0, 1.0]),
        rule: ReversalRule::EXACT,
    };
    Synthetic { v, z, e, grid }
}

/// The moments of `z + σe` from the sums of both.
fn superposed(regression: &Regression, s: &Synthetic, sigma: f64, checkpoint: usize) -> Moments {
    let lags = |x: &[f64], y: &[f64]| regression.lag_products(x, y).swap_remove(checkpoint);
    let input = |x: &[f64]| regression.input_products(x).swap_remove(checkpoint);
    let cross = lags(&s.z, &s.e);
    let lags = lags(&s.z, &s.z) + (&cross + cross.transpose()) * sigma + lags(&s.e, &s.e) * (sigma * sigma);
    regression.moments(checkpoint, &lags, &(input(&s.z) + input(&s.e) * sigma))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn superposed_sums_give_the_estimate_of_the_record(seed: u64, sigma in 0.001..0.3_f64) {
        let s = synthetic(seed, 700);
        let checkpoints = [400, 650];
        let regression = Regression::new(&s.v, s.grid.clone(), &checkpoints).unwrap();
        for (c, n) in checkpoints.into_iter().enumerate() {
            let fast = regression.estimate(&superposed(&regression, &s, sigma, c)).unwrap();
            let end = regression.start() + n;
            let y = s.z.iter().zip(&s.e).map(|(z, e)| z + sigma * e).take(end).collect();
            let slow = one_shot(&[&Record::new(s.v[..end].to_vec(), y).unwrap()], &s.grid).unwrap();
            prop_assert_eq!(fast.samples, slow.samples);
            let values = |e: &Estimate| {
                let points = e.descending.iter().chain(&e.ascending);
                let points = points.flat_map(|p| [p.f, p.se]).collect::<Vec<_>>();
                [e.a.clone(), e.a_se.clone(), e.b.clone(), e.b_se.clone(), points].concat()
            };
            for (f, s) in values(&fast).into_iter().zip(values(&slow)) {
                prop_assert!((f - s).abs() < 1e-8 * (1.0 + s.abs()), "{} against {}", f, s);
            }
        }
    }

    #[test]
    fn the_first_order_part_leaves_an_error_of_second_order(seed: u64) {
        let s = synthetic(seed, 2100);
        let regression = Regression::new(&s.v, s.grid.clone(), &[2000]).unwrap();
        let clean = superposed(&regression, &s, 0.0, 0);
        let limit = Limit::of(&regression, &clean, 1.0).unwrap();
        let remainder = |sigma: f64| -> f64 {
            let moments = superposed(&regression, &s, sigma, 0);
            let estimate = regression.estimate(&moments).unwrap();
            let points = estimate.descending.iter().chain(&estimate.ascending).map(|p| p.f);
            let values = estimate.a.iter().chain(&estimate.b).copied().chain(points);
            let first = limit.first_order(&moments);
            let parts = values.zip(limit.parameters()).zip(first).map(|((x, l), f)| (x - l - f).powi(2));
            parts.sum::<f64>().sqrt()
        };
        let (small, large) = (remainder(1e-4), remainder(1e-3));
        prop_assert!(small < 0.02 * large, "{} should be a hundredth of {}", small, large);
    }
}
