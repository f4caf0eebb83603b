//! What antithetic partners gain: of the leaf spring's estimates, the part of the error that is left after the control variate, split into what
//! changes its sign with the noise (odd) and what does not (even).
//!
//! A replicate and its partner, σ and −σ, have the mean of the even part alone. Studies estimate a partner for every replicate, so that the variance
//! of a mean falls by the factor `1 + Var(odd)/Var(even)`.
//!
//! `cargo run --example antithetic -- REPLICATES`

#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    reason = "an example prints, and takes an argument"
)]

use std::error::Error;
use switchback_identify::excitation::{Direction, PulseExperiment};
use switchback_identify::pulse::{Limit, PulseData, PulseMethod, SecondOrder, StepMean};
use switchback_identify::simulation::{NoiseMoments, PeriodicDesign, periodic_response, superpose};
use switchback_model::hysteresis::{Interval, LeafSpring, SwitchedHysteresis};
use switchback_model::linear::LinearSystem;
use switchback_noise::{NoisePlan, StreamId, samples};

/// Methods by number.
const METHODS: [&str; 3] = ["paper-descendant", "joint", "efficient"];
const BURN_IN: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let replicates: u32 = std::env::args().nth(1).map_or(Ok(100), |text| text.parse())?;
    println!("Var(odd)/Var(even) over the parameters: least, median, largest");
    for (points, sigma, length) in [4, 16]
        .iter()
        .flat_map(|&m| [0.05, 0.8].into_iter().flat_map(move |s| [1_000, 10_000].map(move |n| (m, s, n))))
    {
        let ratios = Setting::new(points, sigma, length)?.ratios(replicates)?;
        for (name, mut ratios) in METHODS.into_iter().zip(ratios) {
            ratios.sort_by(f64::total_cmp);
            let [least, middle, most] = [0, ratios.len() / 2, ratios.len() - 1].map(|k| ratios[k]);
            println!(
                "m = {points:2}, noise {sigma:4}, N = {length:5}, {name:16} {least:.4} {middle:.4} {most:.4}"
            );
        }
    }
    Ok(())
}

/// The experiments of one leaf spring.
struct Setting {
    system: LinearSystem,
    designs: [PeriodicDesign; 2],
    responses: [Vec<f64>; 2],
    satellite: f64,
    sigma: f64,
    samples: usize,
}

impl Setting {
    fn new(points: usize, sigma: f64, samples: usize) -> Result<Self, Box<dyn Error>> {
        let system = LinearSystem::new(vec![-1.2, 0.45], vec![0.15, 0.10])?;
        let interval = Interval::new(-40.0, 40.0)?;
        let spring = SwitchedHysteresis::new(interval, Box::new(LeafSpring::constant(0.2, 1.5)?))?;
        let design = |direction| {
            let experiment = PulseExperiment::evenly_spaced(interval, direction, points, 2)?;
            Ok::<_, Box<dyn Error>>(PeriodicDesign::new(&experiment, &spring, 2))
        };
        let designs = [design(Direction::Descendant)?, design(Direction::Ascendant)?];
        let responses = [0, 1].map(|k: usize| periodic_response(&system, &designs[k].u));
        let satellite = system.static_gain() * spring.u_high();
        Ok(Self { system, designs, responses, satellite, sigma, samples })
    }

    /// Statistics of both experiments, and the step experiment's mean, with this noise.
    fn data(&self, sigma: f64, moments: &[NoiseMoments; 2], step: f64) -> ([PulseData; 2], StepMean) {
        let data = [0, 1].map(|k| superpose(&self.designs[k], &self.responses[k], sigma, &moments[k]));
        (data, StepMean { mean: self.satellite + sigma * step, samples: self.samples as f64 })
    }

    /// Of every method, the ratio of every parameter.
    fn ratios(&self, replicates: u32) -> Result<[Vec<f64>; 3], Box<dyn Error>> {
        let period = self.designs[0].period();
        let expected = NoiseMoments::expected_over(self.system.a(), &[], 2, period, self.samples);
        let (expected, settled) = self.data(self.sigma, &[expected.clone(), expected], 0.0);
        let of_limits = [&expected[0], &expected[1]];
        let limits = methods(&of_limits, settled).map(Limit::of);
        let mut sums: [Vec<[f64; 4]>; 3] = Default::default();
        for replicate in 0..replicates {
            let plan = NoisePlan {
                ar: self.system.a().to_vec(),
                ma: Vec::new(),
                lags: 2,
                periods: vec![period],
                checkpoints: vec![self.samples],
                burn_in: BURN_IN,
            };
            let draw = |experiment| samples(&plan, StreamId { seed: 1, experiment, replicate }, self.samples);
            let (descendant, ascendant, step) = (draw(0)?, draw(1)?, draw(2)?);
            let moments = [descendant, ascendant].map(|open| {
                NoiseMoments::from_samples(&open.e[BURN_IN - 2..BURN_IN + self.samples], 2, period)
            });
            let step = step.e[BURN_IN..BURN_IN + self.samples].iter().sum::<f64>() / self.samples as f64;
            let sides = [self.sigma, -self.sigma].map(|sigma| self.data(sigma, &moments, step));
            for (m, limit) in limits.iter().enumerate() {
                let limit = limit.as_ref().map_err(Clone::clone)?;
                let mut left: Vec<Vec<f64>> = Vec::new();
                for (data, step) in &sides {
                    let both = [&data[0], &data[1]];
                    let sample = methods(&both, *step)[m];
                    let terms = limit.terms(&sample, SecondOrder::Whole);
                    let (fit, truth) = (sample.fit()?, limit.fit().parameters().map(|x| x.value));
                    let errors = fit.parameters().zip(truth).map(|(x, truth)| x.value - truth);
                    let known = terms.first.iter().zip(&terms.second).map(|(x, y)| x + y);
                    left.push(errors.zip(known).map(|(error, known)| error - known).collect());
                }
                sums[m].resize(left[0].len(), [0.0; 4]);
                for (sums, (plus, minus)) in sums[m].iter_mut().zip(left[0].iter().zip(&left[1])) {
                    let (odd, even) = (0.5 * (plus - minus), 0.5 * (plus + minus));
                    let more = [odd, odd * odd, even, even * even];
                    sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
                }
            }
        }
        let count = f64::from(replicates);
        let variance = |sum: f64, squares: f64| squares / count - (sum / count).powi(2);
        let ratio = |[o, oo, e, ee]: &[f64; 4]| variance(*o, *oo) / variance(*e, *ee);
        Ok(sums.map(|sums| sums.iter().map(ratio).collect()))
    }
}

/// The methods, by [their names](METHODS).
fn methods<'a>(both: &'a [&'a PulseData; 2], step: StepMean) -> [PulseMethod<'a>; 3] {
    [
        PulseMethod::Paper { experiment: both[0], step },
        PulseMethod::Joint { descendant: both[0], ascendant: both[1] },
        PulseMethod::Efficient(both),
    ]
}
