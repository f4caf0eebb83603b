//! Eight replicates abreast against the methods one replicate at a time.

use crate::sweep::{Setup, methods, noise, systems};
use proptest::prelude::*;
use switchback_identify::pulse::lanes::{LANES, Lane, LaneFit, LaneMethod, LaneSample, LaneStep, LaneTerms};
use switchback_identify::pulse::{ErrorTerms, Limit, PulseData, PulseMethod, SecondOrder, StepMean};
use switchback_identify::simulation::{
    Grouping, LaneCross, LaneGroupedNoise, LaneMoments, LaneSuperposition, NoiseMoments, superpose,
};

fn step_of(method: &PulseMethod<'_>) -> Option<StepMean> {
    match method {
        PulseMethod::Paper { step, .. } => Some(*step),
        _ => None,
    }
}

fn near(what: &str, fast: f64, slow: f64, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert!((fast - slow).abs() < tolerance, "{}: {} against {}", what, fast, slow);
    Ok(())
}

/// Several samples in one call, more than go abreast, give what each gives by itself.
fn several_give_the_bits_of_one(
    method: &LaneMethod,
    sample: LaneSample<'_>,
    alone: &LaneFit,
) -> Result<(), TestCaseError> {
    let mut fits: [LaneFit; 6] = Default::default();
    method.fit(&[sample; 6], &mut fits);
    let bits = |lanes: &[Lane]| lanes.iter().flat_map(|x| x.0.map(f64::to_bits)).collect::<Vec<_>>();
    for fit in &fits {
        prop_assert_eq!(fit.sound, alone.sound);
        prop_assert_eq!(bits(&fit.values), bits(&alone.values));
        prop_assert_eq!(bits(&fit.variances), bits(&alone.variances));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn lanes_give_what_every_replicate_gives_by_itself(
        (system, order) in systems(), friction in 0.1..1.0_f64, points in 1..=9_usize, sigma in 0.02..0.5_f64, samples in 0..60_usize, seed in 0..1000_u64,
    ) {
        let setup = Setup::new(system, order, friction, points, samples);
        let moments: Vec<[NoiseMoments; 2]> =
            (0..LANES as u64).map(|l| [0, 1].map(|k| setup.moments(seed * 100 + 2 * l + k))).collect();
        let step_noise = noise(seed, LANES).iter().map(|x| x / (setup.samples as f64).sqrt()).collect::<Vec<_>>();
        let lanes: [_; 2] = std::array::from_fn(|k| {
            let mut all = LaneMoments::zeros(order, setup.designs[k].period()).with_left(order);
            moments.iter().enumerate().for_each(|(l, m)| all.set(l, &m[k]));
            let grouped = LaneGroupedNoise::new(&Grouping::new(&setup.designs[k], setup.samples), &all);
            let superposition = LaneSuperposition::new(&setup.designs[k], &setup.responses[k], setup.samples);
            let mut cross = LaneCross::default();
            superposition.cross(&grouped, &mut cross);
            let mut statistics = superposition.statistics();
            superposition.at((&grouped, &cross), sigma, &mut statistics);
            statistics
        });
        let expected: [PulseData; 2] = std::array::from_fn(|k| {
            let m =
                NoiseMoments::expected_over(setup.system.a(), &[], order, setup.designs[k].period(), setup.samples);
            superpose(&setup.designs[k], &setup.responses[k], sigma, &m)
        });
        let expected = [&expected[0], &expected[1]];
        let settled = [0, 1].map(|k| setup.step(k, sigma, 0.0));
        let mut fits = [LaneFit::default()];
        let orders = [SecondOrder::Whole, SecondOrder::Profile];
        for (m, (example, experiments)) in methods(&expected, settled).into_iter().enumerate() {
            let method = LaneMethod::of(&example);
            let parts: Vec<_> = experiments.iter().map(|k| &lanes[*k]).collect();
            let step = step_of(&example).map(|_| LaneStep {
                mean: Lane(std::array::from_fn(|l| setup.step(experiments[0], sigma, step_noise[l]).mean)),
                samples: setup.samples as f64,
            });
            let sample = [LaneSample { parts: &parts, step }];
            method.fit(&sample, &mut fits);
            let [fit] = &fits;
            several_give_the_bits_of_one(&method, sample[0], fit)?;
            let limit = Limit::of(example).ok();
            let terms = limit.as_ref().map(|limit| {
                orders.map(|second| {
                    let mut terms = [LaneTerms::default()];
                    limit.lanes(second).terms(&sample, &mut terms);
                    terms
                })
            });
            for l in 0..LANES {
                let data: [PulseData; 2] =
                    std::array::from_fn(|k| superpose(&setup.designs[k], &setup.responses[k], sigma, &moments[l][k]));
                let both = [&data[0], &data[1]];
                let steps = [0, 1].map(|k| setup.step(k, sigma, step_noise[l]));
                let slow_method = methods(&both, steps)[m].0;
                let Ok(slow) = slow_method.fit() else { continue };
                if m == 6 && order > setup.system.a().len() {
                    // What is superfluous is determined by nothing: the folds hold no noise to fit it to.
                    continue;
                }
                prop_assert!(fit.sound[l], "method {} has an estimate", m);
                let scale = slow.parameters().fold(1.0_f64, |s, p| s.max(p.value.abs()));
                // Of an order too large only the noise determines what is superfluous: rounding is amplified by the condition of
                // the normal equations, and so is the standard error.
                let se = slow.parameters().fold(0.0_f64, |s, p| s.max(p.se));
                // The same goes for the steps from a start that is far off, in a few periods of much noise; where they ran away altogether
                // (the true parameters are of order one) each step multiplies it.
                if m == 6 && (se > 1.0 || scale > 50.0) {
                    continue;
                }
                let superfluous = order > setup.system.a().len();
                let tolerance = (1e-9 * scale).max(if superfluous || m == 6 { 1e-6 * se } else { 0.0 });
                for (k, p) in slow.parameters().enumerate() {
                    near(&format!("method {m}, parameter {k}"), fit.values[k].0[l], p.value, tolerance)?;
                    near(&format!("method {m}, se {k}"), fit.variances[k].0[l].sqrt(), p.se, tolerance)?;
                }
                for (limit, terms) in limit.iter().zip(&terms) {
                    for (order, [fast]) in orders.into_iter().zip(terms) {
                        let ErrorTerms { first, second } = limit.terms(&slow_method, order);
                        for (k, slow) in first.into_iter().enumerate() {
                            near(&format!("method {m}, {order:?}, first order {k}"), fast.first[k].0[l], slow, tolerance)?;
                        }
                        for (k, slow) in second.into_iter().enumerate() {
                            near(&format!("method {m}, {order:?}, second order {k}"), fast.second[k].0[l], slow, tolerance)?;
                        }
                    }
                }
            }
        }
    }
}
