//! A machine simulated by plain loops in short steps: play, leaf spring, a second-order resonance, a noisy sensor.
//!
//! ```text
//! p = v but for the play,   u = k·p + k₂·p³ ± F_C (− while p falls; u stands still with p),   ÿ + 2ζω ẏ + ω² y = ω² u
//! ```
//!
//! The drive is played by a controller that holds each position for a sample, or goes on between the samples: then friction turns between
//! them too, at times that no record holds.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;
use std::fmt;
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// Half the stroke, mm.
const STROKE: f64 = 20.0;
/// Time that the first move over the whole stroke takes, and that the drive takes to set in, s.
const ONCE: f64 = 2.0;
const SETTLED: f64 = 0.2;
/// Steps of the simulation a sample, at least, and a second.
const STEPS: usize = 8;
const STEPS_A_SECOND: f64 = 16_000.0;

/// What drives the machine.
#[derive(Debug, Clone)]
enum Drive {
    /// Amplitudes, frequencies (Hz) and phases of sines.
    Sines(Vec<[f64; 3]>),
    /// Times (s) and positions of turning points, straight lines between.
    Triangles(Vec<[f64; 2]>),
}

impl Drive {
    fn at(&self, t: f64) -> f64 {
        match self {
            Self::Sines(sines) => {
                sines.iter().map(|[a, f, phase]| a * (2.0 * PI * f * t + phase).sin()).sum()
            }
            Self::Triangles(turns) => {
                let k = turns.partition_point(|turn| turn[0] <= t).clamp(1, turns.len() - 1);
                let ([t0, v0], [t1, v1]) = (turns[k - 1], turns[k]);
                v0 + (v1 - v0) * (t - t0) / (t1 - t0)
            }
        }
    }
}

/// A machine and how it was recorded.
#[derive(Debug, Clone)]
pub(crate) struct Machine {
    rate: f64,
    seconds: f64,
    frequency: f64,
    damping: f64,
    stiffness: f64,
    hardening: f64,
    friction: f64,
    play: f64,
    /// Standard deviation of the sensor's noise over that of the output.
    noise: f64,
    drive: Drive,
    kind: &'static str,
    /// Whether each position is held for a sample.
    holds: bool,
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rate, seconds, frequency, damping, noise, kind, .. } = self;
        write!(
            f,
            "{kind} {rate} Hz {seconds:.0} s, {frequency:.1} Hz, damping {damping:.2}, noise {:.1} %",
            100.0 * noise
        )
    }
}

/// Uniform numbers between two ends.
fn uniform(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// A normal deviate: twelve uniform numbers make one well enough.
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| uniform(rng, 0.0, 1.0)).sum::<f64>() - 6.0
}

impl Machine {
    /// A machine by its seed; the play, mm, and whether each position is held for a sample, are as asked for.
    pub(crate) fn draw(seed: u64, play: f64, holds: bool) -> Self {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let rate = [200.0, 250.0, 500.0, 1000.0][seed as usize % 4];
        let seconds = uniform(rng, 20.0, if rate > 400.0 { 24.0 } else { 40.0 });
        let (kind, drive) = match seed % 3 {
            0 => ("sines    ", multisine(rng)),
            1 => ("random   ", band_limited(rng)),
            _ => ("triangles", triangles(rng, seconds)),
        };
        Self {
            rate,
            seconds,
            frequency: uniform(rng, 25.0, 45.0),
            damping: uniform(rng, 0.05, 0.3),
            stiffness: uniform(rng, 0.1, 0.3),
            hardening: uniform(rng, 0.0, 2e-4),
            friction: uniform(rng, 0.3, 1.2),
            play,
            noise: uniform(rng, 0.005, 0.02),
            drive,
            kind,
            holds,
        }
    }

    /// The records: the last third is held out.
    pub(crate) fn rig(&self, seed: u64) -> Rig {
        let (v, y) = self.recorded(seed);
        let cut = v.len() - v.len() / 3;
        let record = |name: &str, usage, part: std::ops::Range<usize>| RigRecord {
            name: name.to_owned(),
            role: Role::Free,
            usage,
            record: Record::new(v[part.clone()].to_vec(), y[part].to_vec()).expect("finite and equally long"),
            predicted: None,
        };
        Rig {
            name: "machine".to_owned(),
            sample_time: 1.0 / self.rate,
            order: None,
            interval: None,
            input_label: "travel [mm]".to_owned(),
            output_label: "force [kN]".to_owned(),
            records: vec![
                record("first two thirds", Usage::Fit, 0..cut),
                record("last third", Usage::Holdout, cut..v.len()),
            ],
        }
    }

    /// The whole record as a CSV file, with the digits that such recorders write.
    pub(crate) fn csv(&self, seed: u64) -> String {
        let (v, y) = self.recorded(seed);
        let rows = v.iter().zip(&y).enumerate();
        let row = |(k, (v, y)): (usize, (&f64, &f64))| format!("{:.3},{v:.3},{y:.4}\n", k as f64 / self.rate);
        std::iter::once("time [s],travel [mm],force [kN]\n".to_owned()).chain(rows.map(row)).collect()
    }

    /// The position at a time: once over the whole stroke first, to load the borders, then the drive.
    fn driven(&self, t: f64) -> f64 {
        match t - ONCE {
            after if after < 0.0 => STROKE * (2.0 * PI * t / ONCE).sin(),
            after => (1.0 - (-after / SETTLED).exp()) * self.drive.at(after),
        }
    }

    /// Position and measured force, sample by sample.
    fn recorded(&self, seed: u64) -> (Vec<f64>, Vec<f64>) {
        let steps = STEPS.max((STEPS_A_SECOND / self.rate) as usize);
        let h = 1.0 / (self.rate * steps as f64);
        let omega = 2.0 * PI * self.frequency;
        let mut p = self.driven(0.0);
        let mut u = self.elastic(p);
        let (mut y, mut speed) = (u, 0.0);
        let (mut v, mut force) = (Vec::new(), Vec::new());
        let samples = (self.seconds * self.rate) as usize;
        for sample in 0..samples {
            v.push(self.driven(sample as f64 / self.rate));
            force.push(y);
            for step in 1..=steps {
                let share = if self.holds { 0.0 } else { step as f64 / steps as f64 };
                let now = self.driven((sample as f64 + share) / self.rate);
                let moved = p.max(now - 0.5 * self.play).min(now + 0.5 * self.play);
                if moved != p {
                    u = self.elastic(moved) + self.friction * (moved - p).signum();
                    p = moved;
                }
                // Semi-implicit Euler: the steps are short against the period.
                speed += h * (omega * omega * (u - y) - 2.0 * self.damping * omega * speed);
                y += h * speed;
            }
        }
        let mean = force.iter().sum::<f64>() / samples as f64;
        let sd = (force.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / samples as f64).sqrt();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(1);
        force.iter_mut().for_each(|y| *y += self.noise * sd * normal(&mut rng));
        (v, force)
    }

    fn elastic(&self, x: f64) -> f64 {
        self.stiffness * x + self.hardening * x.powi(3)
    }
}

/// Ten sines between 0.2 and 4 Hz, slower ones larger.
fn multisine(rng: &mut ChaCha8Rng) -> Drive {
    let sines = (0..10).map(|k| {
        let f = 0.2 * 20_f64.powf((f64::from(k) + uniform(rng, 0.0, 1.0)) / 10.0);
        [f.powf(-0.7), f, uniform(rng, 0.0, 2.0 * PI)]
    });
    within_stroke(sines.collect())
}

/// Noise up to a few Hz: two hundred sines of equal size.
fn band_limited(rng: &mut ChaCha8Rng) -> Drive {
    let band = uniform(rng, 1.5, 4.0);
    let sines =
        (0..200).map(|_| [1.0, uniform(rng, 0.05, band), uniform(rng, 0.0, 2.0 * PI)]).collect::<Vec<_>>();
    within_stroke(sines)
}

/// Sines scaled so that they reach the end of the stroke.
fn within_stroke(mut sines: Vec<[f64; 3]>) -> Drive {
    let raw = Drive::Sines(sines.clone());
    let most = (0..40_000).map(|k| raw.at(f64::from(k) * 1e-3).abs()).fold(0.0, f64::max);
    sines.iter_mut().for_each(|s| s[0] *= STROKE / most);
    Drive::Sines(sines)
}

/// Straight moves between levels anywhere in the stroke, each at a speed of its own.
fn triangles(rng: &mut ChaCha8Rng, seconds: f64) -> Drive {
    let mut turns = vec![[0.0, -STROKE]];
    let (mut t, mut v) = (0.0, -STROKE);
    while t < seconds + 1.0 {
        let upwards = turns.len() % 2 == 1;
        let next = if upwards { uniform(rng, v, STROKE) } else { uniform(rng, -STROKE, v) };
        if (next - v).abs() < 0.5 {
            // Conversely from here would be no reversal.
            let far = if upwards { STROKE } else { -STROKE };
            t += (far - v).abs().max(1e-3) / 80.0;
            v = far;
        } else {
            t += (next - v).abs() / uniform(rng, 30.0, 250.0);
            v = next;
        }
        turns.push([t, v]);
    }
    Drive::Triangles(turns)
}
