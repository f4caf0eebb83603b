//! The means of the control variate's terms, against a sum over noise that is exact for quadratics.

use crate::sweep::{Setup, methods, systems};
use nalgebra::{Cholesky, DMatrix};
use proptest::prelude::*;
use switchback_identify::pulse::{ErrorTerms, Limit, PulseData, SecondOrder};
use switchback_identify::simulation::{NoiseMoments, PeriodicDesign, SumCovariance, superpose};
use switchback_model::linear::autocovariance;

/// Noise of both experiments whose plain average over all of them is the mean over all Gaussian noise of every quadratic.
///
/// With `LLᵀ` the covariance of `d` variables, `E[f] = (1/2d) Σ_k (f(√d L_k) + f(−√d L_k))` for every polynomial `f` of degree two
/// (Julier and Uhlmann, "Unscented filtering and nonlinear estimation", Proceedings of the IEEE 92 (2004), 401–422).
fn sigma_points(gamma: &[f64]) -> Vec<[Vec<f64>; 2]> {
    let length = gamma.len();
    let covariance = DMatrix::from_fn(length, length, |i, j| gamma[i.abs_diff(j)]);
    let factor = Cholesky::new(covariance).expect("a covariance").unpack();
    let spread = (2.0 * length as f64).sqrt();
    let mut points = Vec::with_capacity(4 * length);
    for (experiment, column) in (0..2).flat_map(|k| (0..length).map(move |c| (k, c))) {
        for sign in [-spread, spread] {
            let mut point = [vec![0.0; length], vec![0.0; length]];
            point[experiment] = factor.column(column).iter().map(|x| sign * x).collect();
            points.push(point);
        }
    }
    points
}

/// The statistics of both experiments of a setup.
fn data(setup: &Setup, sigma: f64, moments: [NoiseMoments; 2]) -> [PulseData; 2] {
    [0, 1].map(|k| superpose(&setup.designs[k], &setup.responses[k], sigma, &moments[k]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_terms_have_the_means_that_are_taken_off(
        (system, order) in systems(), friction in 0.1..1.0_f64, points in 1..=5_usize, sigma in 0.02..0.5_f64, beyond in 0..40_usize,
        colour in prop::option::of(-0.6..0.6_f64),
    ) {
        let mut setup = Setup::new(system, order, friction, points, 0);
        // One period and a part of another: levels that were visited twice, and others once.
        let period = setup.designs[0].period();
        setup.samples = period + beyond;
        let (ar, ma) = (setup.system.a().to_vec(), Vec::from_iter(colour));
        let both = |moments: NoiseMoments| data(&setup, sigma, [moments.clone(), moments]);
        let finite = both(NoiseMoments::expected_over(&ar, &ma, order, period, setup.samples));
        let steps = [0, 1].map(|k| setup.step(k, sigma, 0.0));
        let finite = [&finite[0], &finite[1]];
        let gamma = autocovariance(&ar, &ma, order + setup.samples - 1);
        let replicates: Vec<[PulseData; 2]> = sigma_points(&gamma)
            .iter()
            .map(|e| data(&setup, sigma, [0, 1].map(|k| NoiseMoments::from_samples(&e[k], order, period))))
            .collect();
        for (m, (method, experiments)) in methods(&finite, steps).into_iter().enumerate() {
            let Ok(limit) = Limit::of(method) else { continue };
            let designs: Vec<&PeriodicDesign> = experiments.iter().map(|k| &setup.designs[*k]).collect();
            let covariance = SumCovariance::new(&designs, (&ar, &ma), sigma, setup.samples);
            let means = limit.mean_terms(&methods(&finite, steps)[m].0, |x, y| covariance.at(x, y));
            let mut sums = [vec![0.0; means.first.len()], vec![0.0; means.first.len()]];
            let mut sizes = [0.0_f64; 2];
            for replicate in &replicates {
                let replicate = [&replicate[0], &replicate[1]];
                let sample = &methods(&replicate, steps)[m].0;
                let ErrorTerms { first, second } = limit.terms(sample, SecondOrder::Profile);
                for (k, terms) in [first, second].iter().enumerate() {
                    for (sum, term) in sums[k].iter_mut().zip(terms) {
                        *sum += term / replicates.len() as f64;
                        sizes[k] = sizes[k].max(term.abs());
                    }
                }
            }
            for (k, means) in [means.first, means.second].iter().enumerate() {
                for (p, (mean, sum)) in means.iter().zip(&sums[k]).enumerate() {
                    // Normal equations of third order have condition numbers of 10⁷: rounding takes as many digits.
                    prop_assert!(
                        (mean - sum).abs() < 1e-8 * (1.0 + sizes[k]),
                        "method {}, term {}, parameter {}: {} against {} of {}", m, k + 1, p, mean, sum, sizes[k]
                    );
                }
            }
            let consistent = (m < 4 && colour.is_none()) || m == 6;
            prop_assert!(!consistent || sums[0].iter().all(|x| x.abs() < 1e-8 * (1.0 + sizes[0])), "method {}: {:?}", m, sums[0]);
        }
    }
}
