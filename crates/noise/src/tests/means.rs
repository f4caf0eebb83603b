//! The means drawn from their law against the law's definition, and against the pass.

use crate::{MeanNoise, NoisePass, NoisePlan, Width};
use proptest::prelude::*;
use switchback_model::linear::autocovariance;

fn plan(ar: Vec<f64>, ma: Vec<f64>, checkpoints: Vec<usize>) -> NoisePlan {
    NoisePlan { ar, ma, lags: 0, periods: vec![1], checkpoints, burn_in: 400 }
}

/// The covariances of the means over many draws.
fn covariance_of_draws(means: &MeanNoise, count: usize, replicates: u32) -> Vec<f64> {
    let mut sums = vec![0.0; count * count];
    means.draw(Width::detect(), 3, 2, 0..replicates, |_, m| {
        (0..count * count).for_each(|k| sums[k] += m[k / count] * m[k % count]);
    });
    sums.iter().map(|s| s / f64::from(replicates)).collect()
}

/// The same of the pass, sample by sample.
fn covariance_of_the_pass(plan: &NoisePlan, replicates: u32) -> Vec<f64> {
    let count = plan.checkpoints.len();
    let mut sums = vec![0.0; count * count];
    let mut pass = NoisePass::new(plan.clone(), Width::detect()).expect("a valid plan");
    pass.run(4, 0, 0..replicates, |_, record| {
        let means: Vec<f64> = record.checkpoints.iter().map(|c| c.folds[0][0] / c.samples as f64).collect();
        (0..count * count).for_each(|k| sums[k] += means[k / count] * means[k % count]);
    });
    sums.iter().map(|s| s / f64::from(replicates)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_law_is_the_double_sum_over_the_autocovariances(
        p in -0.9..0.9_f64, q in -0.9..0.9_f64, c in -1.0..1.0_f64, steps in prop::collection::vec(1..40_usize, 1..5),
    ) {
        let checkpoints: Vec<usize> = steps.iter().scan(0, |n, step| { *n += step; Some(*n) }).collect();
        let plan = plan(vec![-(p + q), p * q], vec![c], checkpoints.clone());
        let longest = checkpoints[checkpoints.len() - 1];
        let gamma = autocovariance(&plan.ar, &plan.ma, longest);
        let law = MeanNoise::new(&plan).expect("a valid plan").covariance();
        for (i, &n) in checkpoints.iter().enumerate() {
            for (j, &m) in checkpoints.iter().enumerate() {
                let sum: f64 = (0..n).flat_map(|s| (0..m).map(move |t| (s, t))).map(|(s, t)| gamma[s.abs_diff(t)]).sum();
                let direct = sum / (n * m) as f64;
                prop_assert!((law[(i, j)] - direct).abs() < 1e-9 * gamma[0], "{} and {}: {} against {}", n, m, law[(i, j)], direct);
            }
        }
    }
}

#[test]
fn draws_have_the_covariances_of_the_pass() {
    let plan = plan(vec![-1.2, 0.45], vec![0.4], vec![3, 40, 200]);
    let count = plan.checkpoints.len();
    let replicates = 20_000;
    let drawn = covariance_of_draws(&MeanNoise::new(&plan).expect("a valid plan"), count, replicates);
    let passed = covariance_of_the_pass(&plan, replicates);
    for k in 0..count * count {
        let (i, j) = (k / count, k % count);
        let scale = (drawn[i * count + i] * drawn[j * count + j]).sqrt();
        // Each estimate has a standard deviation of at most √(2/R) of the scale, so they differ by at most √(4/R) of it.
        let allowed = 5.0 * (4.0 / f64::from(replicates)).sqrt() * scale;
        assert!((drawn[k] - passed[k]).abs() < allowed, "{i}, {j}: {} against {}", drawn[k], passed[k]);
    }
}

#[test]
fn a_replicate_has_the_same_means_at_every_width_and_in_every_range() {
    let means = MeanNoise::new(&plan(vec![-0.7], vec![], (1..=150).collect())).expect("a valid plan");
    let draw = |width: Width, replicates: std::ops::Range<u32>| {
        let mut all = Vec::new();
        means.draw(width, 5, 3, replicates, |r, means| all.push((r, means.to_vec())));
        all
    };
    let reference = draw(Width::SINGLE, 0..40);
    for width in Width::available() {
        assert!(draw(width, 0..40) == reference, "{width:?}");
        assert!(draw(width, 13..27) == reference[13..27], "{width:?}");
    }
}
