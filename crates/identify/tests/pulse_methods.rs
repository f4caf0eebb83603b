//! The methods for pulse experiments against dense least squares, closed forms and the truth.

use proptest::prelude::*;
use switchback_identify::excitation::{Direction, PulseExperiment};
use switchback_identify::pulse::{Estimated, Limit, PulseData, PulseFit, PulseMethod, SecondOrder, StepMean};
use switchback_identify::simulation::{NoiseMoments, PeriodicDesign, periodic_response, superpose};
use switchback_model::Record;
use switchback_model::hysteresis::*;
use switchback_model::linear::{LinearSystem, filter};

/// A system with poles and zeros well inside the circle, and not too near each other.
fn systems(order: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = LinearSystem> {
    order
        .prop_flat_map(|n| {
            (prop::collection::vec(-0.75..0.75_f64, n), prop::collection::vec(0.2..1.0_f64, n))
        })
        .prop_filter_map("poles apart, coprime", |(poles, b)| {
            let apart = |p: f64, i: usize| poles.iter().skip(i + 1).all(|q| (p - q).abs() > 0.15);
            if !poles.iter().enumerate().all(|(i, p)| apart(*p, i)) {
                return None;
            }
            let mut c = vec![1.0];
            for p in &poles {
                c.push(0.0);
                for i in (1..c.len()).rev() {
                    c[i] -= p * c[i - 1];
                }
            }
            LinearSystem::new(c.split_off(1), b)
                .ok()
                .filter(|s| switchback_model::linear::relative_coprimeness(s.a(), s.b()) > 1e-3)
        })
}

fn leaf_spring() -> SwitchedHysteresis {
    let interval = Interval::new(-2.0, 3.0).expect("an interval");
    SwitchedHysteresis::new(interval, Box::new(LeafSpring::hardening(0.4, 0.1, 0.7).expect("a leaf spring")))
        .expect("Assumption 1")
}

/// One of every kind, on [−2, 3].
fn every_kind() -> Vec<SwitchedHysteresis> {
    let interval = Interval::new(-2.0, 3.0).expect("an interval");
    let line = |slope, offset| Line { slope, offset };
    let piece = |from, value, slope| Piece { from, value, slope };
    let wave =
        |offset, slope, amplitude, wavelength, phase| Wave { offset, slope, amplitude, wavelength, phase };
    let curve = |offset, centre| SaturatingCurve {
        offset,
        amplitude: 0.8,
        centre,
        width: 0.6,
        slope: 0.1,
        curvature: 0.05,
    };
    let point = |v, u| TablePoint { v, u };
    let kinds: [Result<Box<dyn BorderPair>, BorderError>; 8] = [
        StraightLines::new(line(0.5, 0.4), line(0.3, -0.2)).map(|b| Box::new(b) as _),
        LeafSpring::constant(0.4, 0.7).map(|b| Box::new(b) as _),
        LeafSpring::hardening(0.4, 0.1, 0.7).map(|b| Box::new(b) as _),
        Relay::new((-0.5, 0.8), 1.0, -0.6).map(|b| Box::new(b) as _),
        Discontinuous::new(
            vec![piece(-2.0, -0.4, 0.1), piece(0.3, 0.5, 0.2)],
            vec![piece(-2.0, -0.9, 0.0), piece(-0.7, -0.1, 0.3)],
        )
        .map(|b| Box::new(b) as _),
        NonMonotone::new(wave(0.4, 0.2, 0.5, 1.7, 0.3), wave(-0.5, 0.1, 0.3, 2.3, 1.0))
            .map(|b| Box::new(b) as _),
        General::new(curve(0.2, 0.5), curve(-0.2, -0.4)).map(|b| Box::new(b) as _),
        Table::new(
            vec![point(-2.0, -0.5), point(0.0, 0.1), point(3.0, 1.2)],
            vec![point(-2.0, -1.0), point(1.0, -0.2), point(3.0, 0.9)],
        )
        .map(|b| Box::new(b) as _),
    ];
    kinds
        .into_iter()
        .map(|kind| SwitchedHysteresis::new(interval, kind.expect("valid parameters")).expect("Assumption 1"))
        .collect()
}

struct Rig {
    system: LinearSystem,
    hysteresis: SwitchedHysteresis,
    points: usize,
}

impl Rig {
    fn experiment(&self, direction: Direction) -> PulseExperiment {
        PulseExperiment::evenly_spaced(
            self.hysteresis.interval(),
            direction,
            self.points,
            self.system.order(),
        )
        .expect("levels in the interval")
    }

    /// A record by direct simulation, `xi` its equation error, started settled at the satellite's other end.
    fn simulate(&self, direction: Direction, periods: usize, xi: &[f64]) -> Record {
        let experiment = self.experiment(direction);
        let v = experiment.record_input(periods * experiment.period());
        let before = match direction {
            Direction::Descendant => self.hysteresis.u_low(),
            Direction::Ascendant => self.hysteresis.u_high(),
        };
        let u = self.hysteresis.output(&v, before);
        let xi = if xi.is_empty() { Vec::new() } else { (0..v.len()).map(|t| xi[t % xi.len()]).collect() };
        let y = filter(self.system.a(), self.system.b(), &u, &xi, self.system.static_gain() * before, before);
        Record::new(v, y).expect("finite")
    }

    fn normalised(&self) -> LinearSystem {
        self.system.normalised(self.hysteresis.span())
    }

    fn truth(&self, direction: Direction) -> Vec<f64> {
        let branch = direction.visited_branch();
        let levels = self.experiment(direction).levels().to_vec();
        levels.iter().map(|v| self.hysteresis.border(branch, *v) / self.hysteresis.span()).collect()
    }

    fn step(&self, direction: Direction) -> StepMean {
        let u = match direction {
            Direction::Descendant => self.hysteresis.u_high(),
            Direction::Ascendant => self.hysteresis.u_low(),
        };
        StepMean { mean: self.system.static_gain() * u, samples: 1000.0 }
    }
}

/// Equal to `tolerance`, relative to the largest number in the list where that exceeds 1.
fn near(estimate: &[f64], truth: &[f64], tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(estimate.len(), truth.len());
    let scale = truth.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    for (e, t) in estimate.iter().zip(truth) {
        prop_assert!((e - t).abs() < tolerance * scale, "{:?} against {:?}", estimate, truth);
    }
    Ok(())
}

fn values(list: &[Estimated]) -> Vec<f64> {
    list.iter().map(|x| x.value).collect()
}

fn recovers(
    rig: &Rig,
    fit: &PulseFit,
    directions: &[Direction],
    tolerance: f64,
) -> Result<(), TestCaseError> {
    near(&values(&fit.a), rig.system.a(), tolerance)?;
    near(&values(&fit.b), rig.normalised().b(), tolerance)?;
    for (border, direction) in fit.borders.iter().zip(directions) {
        near(&values(border), &rig.truth(*direction), tolerance)?;
    }
    Ok(())
}

/// Folds want a response that has settled.
fn instrumental_recovers(rig: &Rig) -> Result<(), TestCaseError> {
    let order = rig.system.order();
    let settling = rig.system.settling_samples(1e-13);
    let data = BOTH.map(|direction| {
        let record = rig.simulate(direction, 30 + settling / rig.experiment(direction).period(), &[]);
        PulseData::from_record(&record, direction.visited_branch(), order, settling)
            .expect("a pulse experiment")
    });
    recovers(rig, &PulseMethod::Instrumental(&[&data[0], &data[1]]).fit().expect("excited"), &BOTH, 1e-7)
}

const BOTH: [Direction; 2] = [Direction::Descendant, Direction::Ascendant];

/// Gaussian-like noise that needs no generator: the tests on it are exact algebra, any numbers serve.
fn noise() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0_f64, 97)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn without_noise_every_method_recovers_the_system(system in systems(1..=4), points in 1..=16_usize, kind in 0..8_usize) {
        let rig = Rig { system, hysteresis: every_kind().swap_remove(kind), points };
        let data = BOTH.map(|direction| {
            let record = rig.simulate(direction, 30, &[]);
            PulseData::from_record(&record, direction.visited_branch(), rig.system.order(), 0).expect("a pulse experiment")
        });
        recovers(&rig, &PulseMethod::Joint { descendant: &data[0], ascendant: &data[1] }.fit().expect("excited"), &BOTH, 1e-9)?;
        recovers(&rig, &PulseMethod::Efficient(&[&data[0], &data[1]]).fit().expect("excited"), &BOTH, 1e-9)?;
        instrumental_recovers(&rig)?;
        for (data, direction) in data.iter().zip(BOTH) {
            recovers(&rig, &PulseMethod::Paper { experiment: data, step: rig.step(direction) }.fit().expect("excited"), &[direction], 1e-9)?;
            recovers(&rig, &PulseMethod::Efficient(&[data]).fit().expect("excited"), &[direction], 1e-9)?;
        }
    }

    #[test]
    fn the_paper_s_formulas_by_dense_qr_give_the_same_estimates(system in systems(1..=3), points in 1..=6_usize, xi in noise(), y0 in -1.0..1.0_f64) {
        let rig = Rig { system, hysteresis: leaf_spring(), points };
        let order = rig.system.order();
        for direction in BOTH {
            let record = rig.simulate(direction, 12, &xi);
            let data = PulseData::from_record(&record, direction.visited_branch(), order, 7).expect("a pulse experiment");
            prop_assert_eq!(data.levels.clone(), rig.experiment(direction).levels().to_vec());
            let fit = PulseMethod::Paper { experiment: &data, step: StepMean { mean: y0, samples: 50.0 } }.fit().expect("excited");
            let first = 1 + 7.max(order);
            let (a, b, f) = crate::oracle::paper(&record, direction.visited_branch(), &data.levels, order, first, y0);
            near(&values(&fit.a), &a, 1e-9)?;
            near(&values(&fit.b), &b, 1e-9)?;
            near(&values(&fit.borders[0]), &f, 1e-9)?;
        }
    }

    #[test]
    fn joint_by_dense_qr_gives_the_same_estimates(system in systems(1..=3), points in 1..=6_usize, xi in noise()) {
        let rig = Rig { system, hysteresis: leaf_spring(), points };
        let order = rig.system.order();
        let records = BOTH.map(|direction| rig.simulate(direction, 12, &xi));
        let data = [0, 1].map(|e| PulseData::from_record(&records[e], BOTH[e].visited_branch(), order, 7).expect("a pulse experiment"));
        let fit = PulseMethod::Joint { descendant: &data[0], ascendant: &data[1] }.fit().expect("excited");
        let (a, b, f) = crate::oracle::joint([(&records[0], &data[0].levels), (&records[1], &data[1].levels)], order, 1 + 7.max(order));
        near(&values(&fit.a), &a, 1e-9)?;
        near(&values(&fit.b), &b, 1e-9)?;
        for e in 0..2 {
            near(&values(&fit.borders[e]), &f[e], 1e-9)?;
        }
    }

    #[test]
    fn superposing_response_and_noise_gives_the_statistics_of_the_simulated_record(system in systems(1..=3), points in 1..=6_usize, w in noise(), sigma in 0.01..2.0_f64, extra in 0..40_usize) {
        let rig = Rig { system, hysteresis: leaf_spring(), points };
        let order = rig.system.order();
        for direction in BOTH {
            let experiment = rig.experiment(direction);
            let period = experiment.period();
            // Settle for whole periods, so that the record that is left starts at phase 0.
            let settling = (rig.system.settling_samples(1e-14) / period + 2) * period;
            let samples = 6 * period + extra;
            let v = experiment.record_input(settling + samples);
            let u = rig.hysteresis.output(&v, rig.hysteresis.u_low());
            let xi: Vec<f64> = (0..v.len()).map(|t| sigma * w[(t * t + t) % w.len()]).collect();
            let y = filter(rig.system.a(), rig.system.b(), &u, &xi, 0.0, 0.0);
            let e = filter(rig.system.a(), &[], &xi, &xi, 0.0, 0.0);
            let e: Vec<f64> = e.iter().map(|e| e / sigma).collect();

            let design = PeriodicDesign::new(&experiment, &rig.hysteresis, order);
            let z = periodic_response(&rig.system, &design.u);
            let moments = NoiseMoments::from_samples(&e[1 + settling - order..], order, period);
            let fast = superpose(&design, &z, sigma, &moments);
            let direct = PulseData::from_record(&Record::new(v, y).expect("finite"), direction.visited_branch(), order, settling)
                .expect("a pulse experiment").about(0.0);
            prop_assert_eq!(fast.statistics.samples(), samples as f64);
            let estimates = [&fast, &direct].map(|data| PulseMethod::Efficient(&[data]).fit().expect("excited"));
            near(&values(&estimates[0].a), &values(&estimates[1].a), 1e-9)?;
            near(&values(&estimates[0].b), &values(&estimates[1].b), 1e-9)?;
            let scale = estimates[1].borders[0].iter().fold(1.0, |m: f64, x| m.max(x.value.abs()));
            near(&values(&estimates[0].borders[0]), &values(&estimates[1].borders[0]), 1e-9 * scale)?;
            let se = |fit: &PulseFit| fit.borders[0].iter().map(|x| x.se).collect::<Vec<_>>();
            near(&se(&estimates[0]), &se(&estimates[1]), 1e-8 * scale)?;
        }
    }

    #[test]
    fn expected_statistics_give_back_system_and_noise(system in systems(1..=4), points in 1..=8_usize, sigma in 0.01..1.0_f64) {
        let rig = Rig { system, hysteresis: leaf_spring(), points };
        let order = rig.system.order();
        let data = BOTH.map(|direction| {
            let design = PeriodicDesign::new(&rig.experiment(direction), &rig.hysteresis, order);
            let z = periodic_response(&rig.system, &design.u);
            let moments = NoiseMoments::expected(rig.system.a(), &[], order, design.period(), 1e7);
            superpose(&design, &z, sigma, &moments)
        });
        for fit in [PulseMethod::Joint { descendant: &data[0], ascendant: &data[1] }.fit().expect("excited"), PulseMethod::Efficient(&[&data[0], &data[1]]).fit().expect("excited")] {
            recovers(&rig, &fit, &BOTH, 1e-8)?;
            prop_assert!((fit.noise_sd / sigma - 1.0).abs() < 1e-4);
        }
        // The constrained estimator is never less precise.
        let (joint, efficient) = (PulseMethod::Joint { descendant: &data[0], ascendant: &data[1] }.fit().expect("excited"), PulseMethod::Efficient(&[&data[0], &data[1]]).fit().expect("excited"));
        for (j, e) in joint.a.iter().chain(&joint.b).zip(efficient.a.iter().chain(&efficient.b)) {
            prop_assert!(e.se <= j.se * (1.0 + 1e-6));
        }
    }
}

/// Deterministic, roughly Gaussian numbers: enough to see orders of magnitude.
fn gaussian_like(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
}

#[test]
fn the_first_order_part_takes_an_order_of_n_out_of_the_error() {
    let system = LinearSystem::new(vec![-1.2, 0.5], vec![0.3, 0.2]).expect("valid");
    let rig = Rig { system, hysteresis: leaf_spring(), points: 4 };
    let sigma = 0.1;
    let expected = |direction, samples| {
        let design = PeriodicDesign::new(&rig.experiment(direction), &rig.hysteresis, 2);
        let z = periodic_response(&rig.system, &design.u);
        let moments = NoiseMoments::expected(rig.system.a(), &[], 2, design.period(), samples);
        (design, z, moments)
    };
    // Largest error, and largest error after the first-order part is taken out, over both experiments' parameters.
    let sizes = |samples: usize| {
        let mut worst = [[0.0_f64; 2]; 3];
        let mut limits = Vec::new();
        let mut records = Vec::new();
        for (k, direction) in BOTH.into_iter().enumerate() {
            let (design, z, moments) = expected(direction, samples as f64);
            limits.push(superpose(&design, &z, sigma, &moments));
            let w = gaussian_like(k as u64 + 5, samples + 202);
            let e = filter(rig.system.a(), &[], &w, &w, 0.0, 0.0).split_off(200);
            records.push(superpose(&design, &z, sigma, &NoiseMoments::from_samples(&e, 2, design.period())));
        }
        let step = rig.step(Direction::Descendant);
        let step_limit = StepMean { samples: samples as f64, ..step };
        let step_sample =
            StepMean { mean: step.mean + 0.3 * sigma / (samples as f64).sqrt(), samples: samples as f64 };
        let (l, r) = (&limits, &records);
        let pairs = [
            (
                PulseMethod::Paper { experiment: &l[0], step: step_limit },
                PulseMethod::Paper { experiment: &r[0], step: step_sample },
            ),
            (
                PulseMethod::Joint { descendant: &l[0], ascendant: &l[1] },
                PulseMethod::Joint { descendant: &r[0], ascendant: &r[1] },
            ),
            (PulseMethod::Efficient(&[&l[0], &l[1]]), PulseMethod::Efficient(&[&r[0], &r[1]])),
        ];
        for (worst, (limit, sample)) in worst.iter_mut().zip(pairs) {
            let limit = Limit::of(limit).expect("excited");
            let flat = |fit: &PulseFit| fit.parameters().map(|x| x.value).collect::<Vec<_>>();
            let error: Vec<f64> = flat(&sample.fit().expect("excited"))
                .iter()
                .zip(flat(limit.fit()))
                .map(|(e, t)| e - t)
                .collect();
            for (error, first) in error.iter().zip(limit.terms(&sample, SecondOrder::Profile).first) {
                worst[0] = worst[0].max(error.abs());
                worst[1] = worst[1].max((error - first).abs());
            }
        }
        worst
    };
    let (short, long) = (sizes(2_000), sizes(200_000));
    for (short, long) in short.iter().zip(&long) {
        assert!(long[0] < short[0] / 3.0, "the error falls as N^-1/2: {short:?} {long:?}");
        assert!(long[1] < short[1] / 20.0, "its remainder as 1/N: {short:?} {long:?}");
        assert!(long[1] < long[0] / 50.0, "and it is far the smaller: {long:?}");
    }
}

#[test]
fn the_errors_of_the_gain_and_the_levels_cover_what_they_say() {
    let system = LinearSystem::new(vec![-1.1, 0.4], vec![0.8, -0.3]).expect("stable");
    let rig = Rig { system, hysteresis: leaf_spring(), points: 4 };
    let (replicates, sigma) = (150_u64, 0.1);
    let gain = rig.normalised().static_gain();
    let truth = [
        gain,
        rig.system.static_gain() * rig.hysteresis.u_high(),
        rig.system.static_gain() * rig.hysteresis.u_low(),
    ];
    let a_at_one = 1.0 + rig.system.a().iter().sum::<f64>();
    let mut z = [const { Vec::new() }; 6];
    for seed in 0..replicates {
        let scaled =
            |seed, count| gaussian_like(seed, count).into_iter().map(|x| sigma * x).collect::<Vec<_>>();
        let data = [0, 1].map(|e| {
            let record = rig.simulate(BOTH[e], 40, &scaled(2 * seed + e as u64, 2000));
            PulseData::from_record(&record, BOTH[e].visited_branch(), 2, 20).expect("a pulse experiment")
        });
        let exact = rig.step(Direction::Descendant);
        let shift = scaled(seed + 90_000, 1)[0] / (a_at_one * exact.samples.sqrt());
        let step = StepMean { mean: exact.mean + shift, ..exact };
        let both = [&data[0], &data[1]];
        let fits = [PulseMethod::Efficient(&both), PulseMethod::Paper { experiment: &data[0], step }];
        for (k, method) in fits.into_iter().enumerate() {
            let fit = method.fit().expect("excited");
            let (estimate, errors) = (fit.estimate(&both[..fit.borders.len()]), fit.level_errors);
            let pairs = [
                (estimate.gain, errors.gain),
                (estimate.y_high, errors.y_high),
                (estimate.y_low, errors.y_low),
            ];
            for (i, (value, se)) in pairs.into_iter().enumerate() {
                z[3 * k + i].push((value - truth[i]) / se);
            }
        }
    }
    for (i, z) in z.iter().enumerate() {
        let variance = z.iter().map(|z: &f64| z * z).sum::<f64>() / replicates as f64;
        // Four Monte-Carlo standard errors about 1.
        assert!((variance - 1.0).abs() < 4.0 * (2.0 / replicates as f64).sqrt(), "level {i}: {variance}");
    }
}
