//! Refined instrumental variables: what they refuse, and their bias against the second derivatives of the estimate itself.

use crate::sweep::Setup;
use nalgebra::DMatrix;
use switchback_identify::pulse::{
    EquationNoise, ExpectedRecord, Folds, Limit, PulseData, PulseFitError, PulseMethod,
};
use switchback_identify::simulation::{NoiseMoments, superpose};
use switchback_model::Record;
use switchback_model::hysteresis::Branch;
use switchback_model::linear::{LinearSystem, NoiseMemory, autocovariance};

const SIGMA: f64 = 0.01;

/// Expected statistics of a second-order setup with output noise `σ C/D w`.
fn expected(setup: &Setup, (ar, ma): (&[f64], &[f64])) -> [PulseData; 2] {
    [0, 1].map(|k| {
        let noise =
            NoiseMoments::expected(ar, ma, setup.order, setup.designs[k].period(), setup.samples as f64);
        superpose(&setup.designs[k], &setup.responses[k], SIGMA, &noise)
    })
}

/// `ȳ` of one experiment moved along a direction.
fn moved(data: &PulseData, along: &[f64], times: f64) -> PulseData {
    let folds = data.folds.clone().expect("folds");
    let means = folds.means.iter().zip(along).map(|(mean, x)| mean + times * x).collect();
    data.clone().with_folds(Some(Folds { means, ..folds }))
}

fn estimate(data: [&PulseData; 2]) -> Vec<f64> {
    let fit = PulseMethod::Instrumental(&data).fit().expect("excited");
    fit.parameters().map(|x| x.value).collect()
}

#[test]
fn the_bias_is_half_the_second_derivative_of_the_estimate_times_the_covariance_of_the_means() {
    let system = LinearSystem::new(vec![-1.2, 0.45], vec![0.15, 0.10]).expect("a system");
    let laws: [(&[f64], &[f64]); 3] = [(&[-1.2, 0.45], &[]), (&[], &[]), (&[-0.5], &[0.3])];
    for (ar, ma) in laws {
        let mut setup = Setup::new(system.clone(), 2, 0.5, 4, 0);
        let period = setup.designs[0].period();
        setup.samples = 50 * period;
        let data = expected(&setup, (ar, ma));
        let both = [&data[0], &data[1]];
        let limit = Limit::of(PulseMethod::Instrumental(&both)).expect("excited");
        let records = [0, 1].map(|k| ExpectedRecord {
            groups: &setup.designs[k].groups,
            response: &setup.responses[k],
            samples: setup.samples,
        });
        let memory = NoiseMemory::of(ar);
        let theory = limit.finite_sample(&records, EquationNoise { sigma: SIGMA, memory: &memory });
        // The covariance of the means over many periods is circulant: γ wrapped around the period, over their number.
        let gamma = autocovariance(ar, ma, 60 * period);
        let wrapped = |lag: usize| -> f64 {
            let far =
                (1..60).map(|turn| gamma[turn * period + lag] + gamma[turn * period - lag]).sum::<f64>();
            SIGMA * SIGMA * (gamma[lag] + far) / 50.0
        };
        let covariance = DMatrix::from_fn(period, period, |p, q| wrapped(p.abs_diff(q)));
        let factor = covariance.cholesky().expect("a covariance").l();
        let centre = estimate(both);
        let mut slow = vec![0.0; centre.len()];
        for k in 0..2 {
            for along in factor.column_iter() {
                let along: Vec<f64> = along.iter().copied().collect();
                let second = |h: f64| -> Vec<f64> {
                    let side = |times: f64| {
                        let one = moved(&data[k], &along, times);
                        estimate(if k == 0 { [&one, &data[1]] } else { [&data[0], &one] })
                    };
                    let (above, below) = (side(h), side(-h));
                    let pairs = above.iter().zip(&below).zip(&centre);
                    pairs.map(|((a, b), c)| 0.5 * (a + b - 2.0 * c) / (h * h)).collect()
                };
                // Richardson: the error of order h² goes.
                let (coarse, fine) = (second(0.4), second(0.2));
                for (sum, (c, f)) in slow.iter_mut().zip(coarse.iter().zip(&fine)) {
                    *sum += (4.0 * f - c) / 3.0;
                }
            }
        }
        for (k, (fast, slow)) in theory.bias.iter().zip(&slow).enumerate() {
            let small = theory.sd[k] * theory.sd[k];
            assert!(
                (fast - slow).abs() < 1e-3 * slow.abs() + 1e-3 * small,
                "parameter {k}: {fast} against {slow}"
            );
        }
    }
}

#[test]
fn visits_without_a_period_are_refused() {
    let levels = [0.0, 0.5, 0.25, 0.0, 0.25, 0.5, 0.5, 0.0, 0.25, 0.5, 0.0, 0.0];
    let v: Vec<f64> =
        std::iter::repeat_n(1.0, 10).chain(levels.iter().flat_map(|level| [1.0, 1.0, 1.0, *level])).collect();
    let y = (0..v.len()).map(|t| (t as f64).sin()).collect();
    let record = Record::new(v, y).expect("a record");
    let data = PulseData::from_record(&record, Branch::Descending, 1, 0).expect("a pulse experiment");
    assert_eq!(PulseMethod::Instrumental(&[&data]).fit().err(), Some(PulseFitError::NotPeriodic));
}
