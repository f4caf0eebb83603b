//! The whole second-order term of a replicate's error, against differences of the estimators themselves.

use crate::sweep::{Setup, methods, systems};
use proptest::prelude::*;
use switchback_identify::pulse::{GroupedStatistics, Limit, PulseData, PulseMethod, SecondOrder, StepMean};
use switchback_identify::simulation::{NoiseMoments, superpose};

/// `from + times·(to − from)` of every statistic.
fn between(from: &PulseData, to: &PulseData, times: f64) -> PulseData {
    let (x, y) = (&from.statistics, &to.statistics);
    let n = x.order();
    let mix = |x: f64, y: f64| x + times * (y - x);
    let counts = (0..x.groups()).map(|q| x.count(q)).collect();
    let sums = (0..x.groups() * (n + 1)).map(|k| (k / (n + 1), k % (n + 1)));
    let sums = sums.map(|(q, l)| mix(x.sum(q, l), y.sum(q, l))).collect();
    let products = (0..(n + 1) * (n + 1)).map(|k| (k / (n + 1), k % (n + 1)));
    let products = products.map(|(i, l)| mix(x.product(i, l), y.product(i, l))).collect();
    let statistics = GroupedStatistics::from_parts(n, counts, sums, products);
    PulseData::from_statistics(from.branch, from.levels.clone(), from.satellite, statistics)
}

fn estimate(method: PulseMethod<'_>) -> Option<Vec<f64>> {
    Some(method.fit().ok()?.parameters().map(|x| x.value).collect())
}

/// Half the second derivative at 0, by differences of fourth order with steps of this size.
fn half_curvature(at: impl Fn(f64) -> Option<Vec<f64>>, step: f64) -> Option<Vec<f64>> {
    let [far_back, back, here, ahead, far_ahead] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|times| at(times * step));
    let (far_back, back, here, ahead, far_ahead) = (far_back?, back?, here?, ahead?, far_ahead?);
    let second = |p: usize| {
        let near = back[p] - 2.0 * here[p] + ahead[p];
        let far = far_back[p] - 2.0 * here[p] + far_ahead[p];
        0.5 * (16.0 * near - far) / (12.0 * step * step)
    };
    Some((0..here.len()).map(second).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn it_is_half_the_second_derivative_along_the_deviation_of_the_statistics(
        (system, order) in systems(), friction in 0.2..1.0_f64, points in 1..=5_usize, sigma in 0.02..0.3_f64, samples in 0..60_usize,
        seed in 0..1000_u64, step_noise in -0.3..0.3_f64,
    ) {
        // Normal equations of third order have condition numbers of 10⁷: rounding leaves too little of a second difference.
        prop_assume!(order == system.order() && order <= 2);
        let setup = Setup::new(system, order, friction, points, samples);
        let period = setup.designs[0].period();
        let superposed = |k: usize, moments: &NoiseMoments| superpose(&setup.designs[k], &setup.responses[k], sigma, moments);
        let expected = NoiseMoments::expected_over(setup.system.a(), &[], order, period, setup.samples);
        let expected = [0, 1].map(|k| superposed(k, &expected));
        let replicate = [0, 1].map(|k| superposed(k, &setup.moments(2 * seed + k as u64)));
        let [settled, disturbed] = [0.0, step_noise].map(|noise| [0, 1].map(|k| setup.step(k, sigma, noise)));
        // The four methods whose model holds; the last two, wrong models, are linear in their parameters.
        for m in 0..6 {
            let (of_limit, of_sample) = ([&expected[0], &expected[1]], [&replicate[0], &replicate[1]]);
            let (method, _) = methods(&of_limit, settled)[m];
            let Ok(limit) = Limit::of(method) else { continue };
            let (sample, _) = methods(&of_sample, disturbed)[m];
            let terms = limit.terms(&sample, SecondOrder::Whole);
            let along = |times: f64| {
                let data = [0, 1].map(|k| between(&expected[k], &replicate[k], times));
                let steps = [0, 1].map(|k| {
                    let mean = settled[k].mean + times * (disturbed[k].mean - settled[k].mean);
                    StepMean { mean, ..settled[k] }
                });
                estimate(methods(&[&data[0], &data[1]], steps)[m].0)
            };
            let Some(slow) = half_curvature(along, 0.05) else { continue };
            for (p, (fast, slow)) in terms.second.iter().zip(&slow).enumerate() {
                let scale = terms.first[p].powi(2) + slow.abs();
                prop_assert!(
                    (fast - slow).abs() < 1e-4 * scale + 1e-8,
                    "method {}, parameter {}: {} against {}", m, p, fast, slow
                );
            }
        }
    }
}
