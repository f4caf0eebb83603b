//! A machine with play, its verdict, and the repaired model on a new input: `cargo run --example diagnose`.

#![allow(clippy::disallowed_macros, reason = "an example prints")]

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::error::Error;
use switchback_diagnose::{Model, Settings, diagnose};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

fn main() -> Result<(), Box<dyn Error>> {
    let rig = Rig {
        name: "bench".to_owned(),
        sample_time: 0.01,
        order: Some(1),
        interval: None,
        input_label: "travel [mm]".to_owned(),
        output_label: "force [kN]".to_owned(),
        records: vec![
            record("monday", Usage::Fit, 3000, 0.0)?,
            record("tuesday", Usage::Holdout, 1500, 1.0)?,
        ],
    };
    let diagnosis = diagnose(&rig, Model::Identify, &Settings::default())?;
    println!("{}", diagnosis.verdict);
    if let Some(closure) = diagnosis.gap.closure {
        let [low, high] = closure.ci90.map(|share| 100.0 * share);
        println!(
            "closes {:.1} % [{low:.1}, {high:.1}] of the gap on held-out records",
            100.0 * closure.estimate
        );
    }
    for candidate in &diagnosis.candidates {
        println!(
            "{:20} probability {:.2}, BIC drop {:.0}",
            candidate.effect.name(),
            candidate.probability,
            candidate.delta_bic
        );
        for parameter in &candidate.parameters {
            println!("    {} {:.4} {}", parameter.name, parameter.value, parameter.unit);
        }
    }
    let new = drive(10, 2.0);
    if let Some(models) = &diagnosis.models {
        let run = models.augmented.simulate(&new, None);
        println!("the repaired model on a new input, with its 95 % band:");
        for ((v, y), (low, high)) in new.iter().zip(&run.y).zip(run.low.iter().zip(&run.high)) {
            println!("    {v:7.3} mm: {y:7.3} kN [{low:.3}, {high:.3}]");
        }
    }
    Ok(())
}

/// Travel of the bench, mm.
fn drive(samples: usize, phase: f64) -> Vec<f64> {
    (0..samples)
        .map(|t| t as f64)
        .map(|t| 0.55 * (0.17 * t + phase).sin() + 0.45 * (0.025 * t).cos())
        .collect()
}

/// A record of the machine: a play of 0.2 mm, two straight borders 1 kN apart, a first-order lag, a little noise.
fn record(name: &str, usage: Usage, samples: usize, phase: f64) -> Result<RigRecord, Box<dyn Error>> {
    let v = drive(samples, phase);
    let mut random = ChaCha8Rng::seed_from_u64(samples as u64);
    let (mut played, mut u, mut y) = (v[0], 0.0, 0.0);
    let mut force = |v: f64| {
        let noise: f64 = StandardNormal.sample(&mut random);
        y = 0.6 * y + 0.4 * u + 0.01 * noise;
        let moved = played.clamp(v - 0.1, v + 0.1) - played;
        played += moved;
        if moved != 0.0 {
            u = played + 0.5 * moved.signum();
        }
        y
    };
    let y = v.iter().map(|v| force(*v)).collect();
    Ok(RigRecord {
        name: name.to_owned(),
        role: Role::Free,
        usage,
        record: Record::new(v, y)?,
        predicted: None,
    })
}
