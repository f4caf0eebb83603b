//! A leaf spring behind a second-order sensor, identified from the paper's two experiments: `cargo run --example identify`.
//!
//! The records are simulated here; on a setup, play [`PulseExperiment::record_input`] and record `y`.

#![allow(clippy::disallowed_macros, reason = "an example prints")]

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use switchback_identify::BorderPoint;
use switchback_identify::excitation::{Direction, PulseExperiment};
use switchback_identify::pulse::{PulseData, PulseMethod};
use switchback_model::Record;
use switchback_model::hysteresis::{Interval, LeafSpring, SwitchedHysteresis};
use switchback_model::linear::{LinearSystem, filter};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let interval = Interval::new(-40.0, 40.0)?;
    let spring = SwitchedHysteresis::new(interval, Box::new(LeafSpring::hardening(0.12, 6e-5, 2.0)?))?;
    let system = LinearSystem::new(vec![-1.2, 0.45], vec![0.15, 0.10])?;

    // What the setup does: play the input, and measure.
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut measure = |direction: Direction| -> Result<PulseData, Box<dyn std::error::Error>> {
        let experiment = PulseExperiment::evenly_spaced(interval, direction, 8, system.order())?;
        let v = experiment.record_input(500 * experiment.period());
        let before = if direction == Direction::Descendant { spring.u_low() } else { spring.u_high() };
        let u = spring.output(&v, before);
        let mut white = || -> f64 { StandardNormal.sample(&mut random) };
        let xi: Vec<f64> = v.iter().map(|_| 0.2 * white()).collect();
        let y = filter(system.a(), system.b(), &u, &xi, system.static_gain() * before, before);
        Ok(PulseData::from_record(
            &Record::new(v, y)?,
            direction.visited_branch(),
            system.order(),
            experiment.period(),
        )?)
    };
    let experiments = [measure(Direction::Descendant)?, measure(Direction::Ascendant)?];

    let experiments = experiments.each_ref();
    let fit = PulseMethod::Efficient(&experiments).fit()?;
    for (k, (a, truth)) in fit.a.iter().zip(system.a()).enumerate() {
        println!("a{} = {:.5} ± {:.5} (truth {truth})", k + 1, a.value, 1.96 * a.se);
    }
    let estimate = fit.estimate(&experiments);
    let reported = |point: &BorderPoint| {
        let [force, se] = [point.f, point.se].map(|x| estimate.gain * x);
        format!("{:6.1} mm: {force:8.3} ± {:.3} kN", point.v, 1.96 * se)
    };
    println!("while the input falls         while it rises");
    for (falling, rising) in estimate.descending.iter().zip(&estimate.ascending) {
        println!("{}   {}", reported(falling), reported(rising));
    }
    Ok(())
}
