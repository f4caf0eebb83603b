//! A small rig with a known model.

use std::f64::consts::PI;

use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// A sweep of reversals of many sizes.
pub(crate) fn input(samples: usize, phase: f64) -> Vec<f64> {
    (0..samples)
        .map(|t| {
            let t = t as f64;
            (0.55 * (2.0 * PI * t / 37.0 + phase).sin() + 0.45 * (2.0 * PI * t / 253.0).cos())
                .clamp(-1.0, 1.0)
        })
        .collect()
}

/// White noise of unit standard deviation, a sum of twelve uniform numbers each.
pub(crate) fn white(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

/// A first-order rig with two straight borders a jump of one apart, and a little noise.
pub(crate) fn output(v: &[f64]) -> Vec<f64> {
    let mut white = white(12_345);
    response(v, &[-0.6], &mut || 0.01 * white())
}

/// A rig `y + a₁ y(t−1) + … = A(1) u(t−1) + ξ` with the same borders.
pub(crate) fn response(v: &[f64], a: &[f64], error: &mut impl FnMut() -> f64) -> Vec<f64> {
    let gain = 1.0 + a.iter().sum::<f64>();
    let (mut u, mut past) = (-1.0, vec![0.0; a.len()]);
    (0..v.len())
        .map(|t| {
            let y = gain * u - a.iter().zip(&past).map(|(a, y)| a * y).sum::<f64>() + error();
            past.rotate_right(1);
            past[0] = y;
            if t > 0 && v[t] != v[t - 1] {
                u = v[t] + 0.5 * (v[t] - v[t - 1]).signum();
            }
            y
        })
        .collect()
}

/// The input behind a play of a full width.
pub(crate) fn played(v: &[f64], width: f64) -> Vec<f64> {
    let mut p = v[0];
    v.iter()
        .map(|v| {
            p = p.max(v - 0.5 * width).min(v + 0.5 * width);
            p
        })
        .collect()
}

pub(crate) fn record(name: &str, usage: Usage, v: Vec<f64>, y: Vec<f64>) -> RigRecord {
    let record = Record::new(v, y).expect("finite and equally long");
    RigRecord { name: name.into(), role: Role::Free, usage, record, predicted: None }
}

pub(crate) fn made(name: &str, usage: Usage, samples: usize, phase: f64) -> RigRecord {
    let v = input(samples, phase);
    let y = output(&v);
    record(name, usage, v, y)
}

pub(crate) fn rig(order: Option<usize>, records: Vec<RigRecord>) -> Rig {
    Rig {
        name: "bench".into(),
        sample_time: 0.01,
        order,
        interval: None,
        input_label: "v".into(),
        output_label: "y".into(),
        records,
    }
}

pub(crate) fn whole() -> Vec<RigRecord> {
    vec![made("sweep", Usage::Fit, 3000, 0.0), made("drive", Usage::Holdout, 1500, 1.0)]
}
