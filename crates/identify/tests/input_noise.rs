//! What noise on the input is said to do to an estimate, against what it does.
#![allow(clippy::disallowed_macros, reason = "a test shows what it measured")]

use switchback_identify::free::*;
use switchback_identify::{BorderPoint, Estimate};
use switchback_model::hysteresis::Interval;
use switchback_model::linear::filter;
use switchback_model::record::Record;
use switchback_model::reversal::{ReversalRule, Timing};
use switchback_noise::{StreamId, white_samples};

/// Borders as plain functions: (descending, ascending).
#[derive(Debug, Clone, Copy)]
struct Pair(fn(f64) -> f64, fn(f64) -> f64);

const STRAIGHT: Pair = Pair(|v| 0.5 * v - 0.3, |v| 0.5 * v + 0.3);
const BENT: Pair = Pair(|v| 0.4 * v + 0.2 * v.powi(3) - 0.2, |v| 0.4 * v + 0.2 * v.powi(3) + 0.2);

const A: [f64; 2] = [-1.1, 0.4];
const B: [f64; 2] = [0.8, -0.3];
const SAMPLES: usize = 3000;

/// What small and fast changes of the input are.
#[derive(Debug, Clone, Copy)]
enum Drive {
    /// Noise of the sensor: the machine follows the smooth motion.
    Motion,
    /// Commanded: the machine follows them.
    Dithered,
}

fn added(x: &[f64], noise: &[f64], sd: f64) -> Vec<f64> {
    x.iter().zip(noise).map(|(x, w)| x + sd * w).collect()
}

/// A machine, its drive, and the noise of its sensors.
#[derive(Debug, Clone, Copy)]
struct Case {
    name: &'static str,
    borders: Pair,
    knots: usize,
    motion: fn(f64) -> f64,
    input_sd: f64,
    output_sd: f64,
    /// Sample of the motion with which the record begins.
    later: f64,
    timing: Timing,
    drive: Drive,
    /// Coefficient of the first-order autoregression that the output's noise follows.
    colour: f64,
}

fn sweep(t: f64) -> f64 {
    0.55 * (0.041 * t).sin() + 0.25 * (0.0931 * t + 1.0).sin() + 0.2 * (0.017 * t).cos()
}

fn slow(t: f64) -> f64 {
    0.8 * (0.012 * t).sin() + 0.2 * (0.031 * t + 1.0).sin()
}

fn triangles(t: f64) -> f64 {
    let phase = (t / 80.0).fract();
    (0.7 + 0.3 * (0.003 * t).sin()) * (4.0 * (phase - 0.5).abs() - 1.0)
}

const BASE: Case = Case {
    name: "sweep",
    borders: STRAIGHT,
    knots: 3,
    motion: sweep,
    input_sd: 0.01,
    output_sd: 0.02,
    later: 0.0,
    timing: Timing::BetweenSamples,
    drive: Drive::Motion,
    colour: 0.0,
};

impl Case {
    fn motion(self) -> Vec<f64> {
        (0..SAMPLES).map(|t| (self.motion)(self.later + t as f64)).collect()
    }

    /// What drives the machine.
    fn driven_by(self) -> Vec<f64> {
        match self.drive {
            Drive::Motion => self.motion(),
            Drive::Dithered => added(&self.motion(), &self.noise(1, 0), self.input_sd),
        }
    }

    fn noise(self, experiment: u32, draw: u32) -> Vec<f64> {
        white_samples(StreamId { seed: 77, experiment, replicate: draw }, SAMPLES)
    }

    /// The output of a machine that turns when its input does, `timing` reporting whether at samples.
    fn output(self) -> Vec<f64> {
        let knots: Vec<f64> = (0..=200).map(|k| -1.1 + 0.011 * f64::from(k)).collect();
        let Pair(down, up) = self.borders;
        let reference = down(knots[0]);
        let values = knots.iter().skip(1).map(|&v| down(v)).chain(knots.iter().map(|&v| up(v)));
        let coefficients = Coefficients {
            a: A.to_vec(),
            b: B.to_vec(),
            f: values.map(|u| u - reference).collect(),
            c: reference * B.iter().sum::<f64>(),
        };
        let structure = Structure { order: 2, delay: 0 };
        let rule = ReversalRule { timing: self.timing, ..ReversalRule::EXACT };
        let machine =
            Model::new(Basis::borders(knots.clone(), knots), structure, coefficients, rule).unwrap();
        machine.simulate(&self.driven_by(), &[])
    }

    fn record(self, draw: u32) -> Record {
        let v = match self.drive {
            Drive::Motion => added(&self.motion(), &self.noise(1, draw), self.input_sd),
            Drive::Dithered => self.driven_by(),
        };
        let scale = self.output_sd * (1.0 - self.colour * self.colour).sqrt();
        let e = filter(&[-self.colour], &[], &[0.0; SAMPLES], &self.noise(2, draw), 0.0, 0.0);
        Record::new(v, added(&self.output(), &e, scale)).unwrap()
    }

    fn identified(self, draw: u32) -> Identified {
        let settings = Settings {
            order: Some(2),
            delay: Some(0),
            knots: Some(self.knots),
            interval: Some(Interval::new(-1.0, 1.0).unwrap()),
            ..Settings::new(InputMap::Borders)
        };
        identify(&[&self.record(draw)], &settings).unwrap()
    }
}

/// By how much the coefficients and the points of both borders miss the truth, and their standard errors.
fn values(case: Case, estimate: &Estimate) -> (Vec<f64>, Vec<f64>) {
    // u_M − u_m of either pair of borders.
    let span = 1.6;
    let coefficients = estimate.a_coefficients().chain(estimate.b_coefficients());
    let truth = A.into_iter().chain(B.map(|b| span * b));
    let coefficients = coefficients.zip(truth).map(|(c, truth)| (c.value - truth, c.se));
    let missed = |border: fn(f64) -> f64| move |p: &BorderPoint| (p.f - border(p.v) / span, p.se);
    let down = estimate.descending.iter().map(missed(case.borders.0));
    coefficients.chain(down).chain(estimate.ascending.iter().map(missed(case.borders.1))).unzip()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Mean over draws of each parameter.
fn means(draws: &[Vec<f64>]) -> Vec<f64> {
    (0..draws[0].len()).map(|i| mean(&draws.iter().map(|d| d[i]).collect::<Vec<_>>())).collect()
}

#[test]
#[ignore = "takes minutes: prints the table of shifts predicted and found"]
fn table_of_shifts() {
    let draws = 8;
    let cases = [
        Case { input_sd: 0.002, ..BASE },
        Case { input_sd: 0.005, ..BASE },
        BASE,
        Case { input_sd: 0.02, ..BASE },
        Case { colour: 0.9, ..BASE },
        Case { name: "sweep, bent", borders: BENT, knots: 5, ..BASE },
        Case { name: "slow", motion: slow, ..BASE },
        Case { name: "slow", motion: slow, input_sd: 0.003, ..BASE },
        Case { name: "triangles", motion: triangles, ..BASE },
        Case { name: "at samples", timing: Timing::AtSamples, input_sd: 0.002, ..BASE },
        Case { name: "at samples", timing: Timing::AtSamples, ..BASE },
        Case { name: "dithered", drive: Drive::Dithered, ..BASE },
        Case { name: "dithered", drive: Drive::Dithered, input_sd: 0.003, ..BASE },
        Case { name: "triangles, bent", motion: triangles, borders: BENT, knots: 5, ..BASE },
    ];
    for case in cases {
        let clean = Case { input_sd: 0.0, ..case };
        let found: Vec<Identified> = (0..draws).map(|d| case.identified(d)).collect();
        let without: Vec<Vec<f64>> =
            (0..draws).map(|d| values(case, &clean.identified(d).estimate).0).collect();
        let with: Vec<Vec<f64>> = found.iter().map(|f| values(case, &f.estimate).0).collect();
        let se = means(&found.iter().map(|f| values(case, &f.estimate).1).collect::<Vec<_>>());
        let reported: Vec<InputNoise> = found.iter().filter_map(|f| f.input_noise).collect();
        let warned = found.iter().filter(|f| is_warned(f)).count();
        let differences: Vec<Vec<f64>> =
            with.iter().zip(&without).map(|(x, z)| x.iter().zip(z).map(|(x, z)| x - z).collect()).collect();
        let shift = means(&differences);
        let (moved, largest) = largest(&shift, &se);
        let scatter = differences.iter().map(|d| (d[moved] - shift[moved]).powi(2)).sum::<f64>();
        let mut forecast: Vec<f64> = reported.iter().map(|n| n.largest_shift).collect();
        forecast.sort_by(f64::total_cmp);
        let median = forecast.get(forecast.len() / 2).copied().unwrap_or(0.0);
        println!(
            "{:16} {:?} sd {} colour {}: found {}, warned {warned} of {draws}; true {largest:.2} ± {:.2}, predicted {median:.2} ({:.2} to {:.2}), ratio {:.2}",
            case.name,
            case.timing,
            case.input_sd,
            case.colour,
            reported.len(),
            scatter.sqrt() / f64::from(draws) / se[moved],
            forecast.first().unwrap_or(&0.0),
            forecast.last().unwrap_or(&0.0),
            median / largest
        );
    }
}

fn is_warned(found: &Identified) -> bool {
    found.warnings.iter().any(|warning| warning.kind() == "input_noise")
}

/// The parameter that is moved most, and by how many standard errors.
fn largest(shift: &[f64], se: &[f64]) -> (usize, f64) {
    let sizes = shift.iter().zip(se).map(|(shift, se)| (shift / se).abs()).enumerate();
    sizes.max_by(|x, y| x.1.total_cmp(&y.1)).unwrap()
}

#[test]
fn clean_inputs_are_not_warned_of() {
    for motion in [sweep, slow, triangles] {
        for draw in 0..3 {
            let found = Case { motion, input_sd: 0.0, ..BASE }.identified(draw);
            assert!(found.input_noise.is_none() && !is_warned(&found), "{:?}", found.warnings);
        }
    }
}

#[test]
fn the_largest_shift_is_forecast_within_a_factor_of_two_and_warned_of() {
    let case = Case { input_sd: 0.005, ..BASE };
    let clean = Case { input_sd: 0.0, ..case };
    let draws = 0..8;
    let found: Vec<Identified> = draws.clone().map(|d| case.identified(d)).collect();
    let with: Vec<Vec<f64>> = found.iter().map(|f| values(case, &f.estimate).0).collect();
    let without: Vec<Vec<f64>> = draws.map(|d| values(case, &clean.identified(d).estimate).0).collect();
    let se = means(&found.iter().map(|f| values(case, &f.estimate).1).collect::<Vec<_>>());
    let shift: Vec<f64> = means(&with).iter().zip(means(&without)).map(|(x, z)| x - z).collect();
    let (_, truth) = largest(&shift, &se);
    let forecast = mean(&found.iter().map(|f| f.input_noise.unwrap().largest_shift).collect::<Vec<_>>());
    assert!(truth > 1.0, "the case is too easy: {truth}");
    assert!(forecast > 0.5 * truth && forecast < 2.0 * truth, "{forecast} predicted, {truth} true");
    assert!(found.iter().filter(|f| is_warned(f)).count() >= 6);
}

#[test]
#[ignore = "takes minutes: counts warnings on inputs without noise"]
fn false_alarms() {
    for (name, motion) in [("sweep", sweep as fn(f64) -> f64), ("slow", slow), ("triangles", triangles)] {
        let records = (0..40).map(|draw| {
            Case { motion, input_sd: 0.0, later: 700.0 * f64::from(draw), ..BASE }.identified(draw)
        });
        println!("{name}: {} of 40 warned", records.filter(is_warned).count());
    }
}
