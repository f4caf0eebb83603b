//! Bias and standard deviation at a given number of samples, against the delta method carried out by brute force.

use crate::sweep::{Setup, methods};
use nalgebra::{DMatrix, SymmetricEigen};
use proptest::prelude::*;
use switchback_identify::pulse::{
    EquationNoise, ExpectedRecord, GroupedStatistics, Limit, PulseData, PulseMethod, StepMean,
};
use switchback_identify::simulation::{NoiseMoments, superpose};
use switchback_model::linear::{LinearSystem, NoiseMemory, autocovariance};

/// Step of a central difference, in standard deviations of the direction moved along.
const STEP: f64 = 0.1;

/// The statistics of an experiment as one vector: sums, then products.
fn vector(statistics: &GroupedStatistics) -> Vec<f64> {
    let n = statistics.order();
    let sums = (0..statistics.groups()).flat_map(|q| (0..=n).map(move |l| (q, l)));
    let products = (0..=n).flat_map(|i| (0..=n).map(move |l| (i, l)));
    sums.map(|(q, l)| statistics.sum(q, l)).chain(products.map(|(i, l)| statistics.product(i, l))).collect()
}

fn moved(data: &PulseData, by: &[f64], times: f64) -> PulseData {
    let statistics = &data.statistics;
    let values: Vec<f64> = vector(statistics).iter().zip(by).map(|(x, d)| x + times * d).collect();
    let (sums, products) = values.split_at(statistics.groups() * (statistics.order() + 1));
    let counts = (0..statistics.groups()).map(|q| statistics.count(q)).collect();
    let statistics =
        GroupedStatistics::from_parts(statistics.order(), counts, sums.to_vec(), products.to_vec());
    PulseData::from_statistics(data.branch, data.levels.clone(), data.satellite, statistics)
}

/// Covariance of the statistics of one experiment, written out sample by sample: each is `c + lᵀe + eᵀQe`, and by Isserlis' theorem
/// `Cov = l₁ᵀΓl₂ + 2 tr(Q₁ΓQ₂Γ)`.
fn covariance(setup: &Setup, k: usize, sigma: f64, samples: usize) -> DMatrix<f64> {
    let (design, z, n) = (&setup.designs[k], &setup.responses[k], setup.order);
    let (period, length) = (z.len(), samples + n);
    // e(t−l) is entry t − l + n.
    let place = |t: usize, l: usize| t + n - l;
    let gamma = autocovariance(setup.system.a(), &[], length);
    let noise = DMatrix::from_fn(length, length, |i, j| sigma * sigma * gamma[i.abs_diff(j)]);
    let (groups, width) = (design.group_count(), n + 1);
    let size = groups * width + width * width;
    let mut linear = DMatrix::zeros(length, size);
    let mut quadratic = Vec::new();
    for t in 0..samples {
        for l in 0..width {
            linear[(place(t, l), design.groups[t % period] * width + l)] += 1.0;
        }
    }
    for (i, l) in (0..width).flat_map(|i| (0..width).map(move |l| (i, l))) {
        let mut form = DMatrix::zeros(length, length);
        let of_z = |t: usize, lag: usize| z[(t + width * period - lag) % period];
        for t in 0..samples {
            linear[(place(t, l), groups * width + i * width + l)] += of_z(t, i);
            linear[(place(t, i), groups * width + i * width + l)] += of_z(t, l);
            form[(place(t, i), place(t, l))] += 0.5;
            form[(place(t, l), place(t, i))] += 0.5;
        }
        quadratic.push(form * &noise);
    }
    let mut covariance = linear.tr_mul(&(&noise * &linear));
    for (i, x) in quadratic.iter().enumerate() {
        for (j, y) in quadratic.iter().enumerate() {
            covariance[(groups * width + i, groups * width + j)] += 2.0 * (x * y).trace();
        }
    }
    covariance
}

/// Directions `d_j` with `C = Σ d_j d_jᵀ`: of the correlations, so that the eigenvalues of statistics of small variance are as exact as the others.
fn directions(covariance: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let sd = covariance.diagonal().map(f64::sqrt);
    let correlation = DMatrix::from_fn(sd.len(), sd.len(), |i, j| {
        if sd[i] * sd[j] > 0.0 { covariance[(i, j)] / (sd[i] * sd[j]) } else { 0.0 }
    });
    let SymmetricEigen { eigenvalues, eigenvectors } = correlation.symmetric_eigen();
    let largest = eigenvalues.max();
    let all = eigenvalues.iter().enumerate().filter(|(_, value)| **value > 1e-14 * largest);
    all.map(|(j, value)| (eigenvectors.column(j) * value.sqrt()).component_mul(&sd).iter().copied().collect())
        .collect()
}

fn estimate(method: PulseMethod<'_>) -> Vec<f64> {
    method.fit().expect("excited").parameters().map(|x| x.value).collect()
}

/// `½ d²g/dε²` and `(dg/dε)²` summed over directions, by differences of sixth order: so wide a step leaves rounding far below them.
fn add_differences(sums: &mut [Vec<f64>; 2], at: impl Fn(f64) -> Vec<f64>) {
    let here = at(0.0);
    let sides = [1.0, 2.0, 3.0].map(|times| [at(times * STEP), at(-times * STEP)]);
    for p in 0..here.len() {
        let curve = |k: usize| sides[k][0][p] - 2.0 * here[p] + sides[k][1][p];
        let slope = |k: usize| sides[k][0][p] - sides[k][1][p];
        let second = (270.0 * curve(0) - 27.0 * curve(1) + 2.0 * curve(2)) / (180.0 * STEP * STEP);
        let first = (45.0 * slope(0) - 9.0 * slope(1) + slope(2)) / (60.0 * STEP);
        sums[0][p] += 0.5 * second;
        sums[1][p] += first * first;
    }
}

/// Systems of orders 1 and 2 whose order is known.
fn systems() -> impl Strategy<Value = LinearSystem> {
    (1..=2_usize).prop_flat_map(|n| (prop::collection::vec(0.3..1.0_f64, n), -0.6..0.5_f64)).prop_filter_map(
        "coprime",
        |(b, pole)| {
            let a = if b.len() == 1 { vec![-pole] } else { vec![-(pole + 0.3), 0.3 * pole] };
            LinearSystem::new(a, b).ok()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn bias_and_sd_are_those_of_the_delta_method_to_second_order(
        system in systems(), friction in 0.2..1.0_f64, points in 2..=4_usize, sigma in 0.05..0.4_f64, beyond in 0..60_usize,
    ) {
        let order = system.order();
        let mut setup = Setup::new(system, order, friction, points, 0);
        let period = setup.designs[0].period();
        setup.samples = 2 * period + beyond;
        let samples = setup.samples;
        let moments = NoiseMoments::expected_over(setup.system.a(), &[], order, period, samples);
        let data = [0, 1].map(|k| superpose(&setup.designs[k], &setup.responses[k], sigma, &moments));
        let steps = [0, 1].map(|k| setup.step(k, sigma, 0.0));
        let memory = NoiseMemory::of(setup.system.a());
        let directions = [0, 1].map(|k| directions(&covariance(&setup, k, sigma, samples)));
        for m in 0..4 {
            let both = [&data[0], &data[1]];
            let (method, experiments) = methods(&both, steps)[m];
            let limit = Limit::of(method).expect("excited");
            let records: Vec<ExpectedRecord<'_>> = experiments
                .iter()
                .map(|&k| ExpectedRecord { groups: &setup.designs[k].groups, response: &setup.responses[k], samples })
                .collect();
            let theory = limit.finite_sample(&records, EquationNoise { sigma, memory: &memory });
            let mut sums = [vec![0.0; theory.bias.len()], vec![0.0; theory.bias.len()]];
            for &k in experiments {
                for direction in &directions[k] {
                    add_differences(&mut sums, |times| {
                        let mut data = data.clone();
                        data[k] = moved(&data[k], direction, times);
                        estimate(methods(&[&data[0], &data[1]], steps)[m].0)
                    });
                }
            }
            if m < 2 {
                let k = experiments[0];
                let gamma = autocovariance(setup.system.a(), &[], samples);
                let sum: f64 = (0..samples * samples).map(|c| gamma[(c / samples).abs_diff(c % samples)]).sum();
                let sd = sigma * sum.sqrt() / samples as f64;
                add_differences(&mut sums, |times| {
                    let mut steps = steps;
                    steps[k] = StepMean { mean: steps[k].mean + times * sd, ..steps[k] };
                    estimate(methods(&[&data[0], &data[1]], steps)[m].0)
                });
            }
            for (p, (bias, sd)) in theory.bias.iter().zip(&theory.sd).enumerate() {
                let (slow_bias, slow_sd) = (sums[0][p], sums[1][p].sqrt());
                prop_assert!(
                    (bias - slow_bias).abs() < 1e-5 * (slow_bias.abs() + sd * sd),
                    "method {}, parameter {}: bias {} against {}", m, p, bias, slow_bias
                );
                prop_assert!((sd - slow_sd).abs() < 1e-6 * slow_sd, "method {}, parameter {}: sd {} against {}", m, p, sd, slow_sd);
            }
        }
    }
}
