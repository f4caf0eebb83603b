//! Diagnoses of short random rigs: a verdict with finite figures, or a refusal.
//!
//! Input bytes are the order, whether it is declared and which effects are looked for, the lengths of two records, and then the input's steps and the output's noise, one byte each. The
//! output is a made machine's, so that there is something to find; with a large last byte it is noise alone.

use switchback_diagnose::{Effect, Model, Settings, diagnose};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// Shortest record that is made.
const LEAST: usize = 40;

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    let [order, declared, first, second, machine, rest @ ..] = bytes else { return };
    let records: Vec<RigRecord> = [(first, Usage::Fit), (second, Usage::Holdout)]
        .into_iter()
        .enumerate()
        .map(|(k, (length, usage))| RigRecord {
            name: format!("record {k}"),
            role: Role::Free,
            usage,
            record: record(rest, 17 * k, LEAST + usize::from(*length) / 2, *machine),
            predicted: None,
        })
        .collect();
    let rig = Rig {
        name: "fuzz".to_owned(),
        sample_time: 0.01,
        order: (declared % 2 == 1).then_some(1 + usize::from(order % 3)),
        interval: None,
        input_label: "v".to_owned(),
        output_label: "y".to_owned(),
        records,
    };
    // A quarter of the effects at a time: in ten seconds there should be more than one diagnosis.
    let quarter = usize::from(*declared / 2 % 4);
    let effects = Effect::ALL.into_iter().skip(quarter).step_by(4).collect();
    let settings = Settings { effects, max_order: 2, resamples: 20, ..Settings::default() };
    if let Ok(diagnosis) = diagnose(&rig, Model::Identify, &settings) {
        let verdict = &diagnosis.verdict;
        assert!((0.0..=1.0).contains(&verdict.probability), "{verdict:?}");
        assert!(diagnosis.candidates.iter().all(|c| (0.0..=1.0).contains(&c.probability)));
        assert!(diagnosis.gap.noise_floor.is_finite() && diagnosis.gap.before.estimate.is_finite());
    }
}

/// A first-order machine with friction; bytes that are used up begin anew.
fn record(bytes: &[u8], from: usize, samples: usize, machine: u8) -> Record {
    let at = |i: usize| if bytes.is_empty() { 0 } else { bytes[(from + i) % bytes.len()] };
    let pole = 0.9 * f64::from(machine % 16) / 15.0;
    let noise = if machine >= 0xf0 { 1.0 } else { 1e-3 * f64::from(machine / 16) };
    let (mut v, mut y) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    let (mut position, mut sign, mut force) = (0.0_f64, 1.0, 0.0);
    for t in 0..samples {
        let step = f64::from(at(2 * t) as i8) / 16.0;
        let next = (position + step).clamp(-10.0, 10.0);
        if next != position {
            sign = (next - position).signum();
        }
        force = pole * force + (1.0 - pole) * (position + sign);
        position = next;
        v.push(position);
        y.push(force + noise * f64::from(at(2 * t + 1) as i8) / 64.0);
    }
    Record::new(v, y).expect("finite samples of equal number")
}
