//! Ten kinds of borders, as a middle and a half-width along the interval.

use super::random::{log_uniform, one_of};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

/// The course of the middle between both borders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A line.
    Straight,
    /// A spring that stiffens or softens.
    Cubic,
    /// A line with one to three jumps.
    Jumps,
    /// A line with waves.
    Wavy,
    /// A step between two levels.
    Relay,
    /// A line that saturates at both ends.
    Saturating,
    /// A smooth random curve.
    Random,
    /// A curve that bends one way.
    Convex,
    /// Flat in the middle, a spring beyond.
    DeadZone,
    /// Hardly any slope: friction alone.
    Flat,
}

impl Kind {
    pub(super) const ALL: [Self; 10] = [
        Self::Straight,
        Self::Cubic,
        Self::Jumps,
        Self::Wavy,
        Self::Relay,
        Self::Saturating,
        Self::Random,
        Self::Convex,
        Self::DeadZone,
        Self::Flat,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Cubic => "cubic",
            Self::Jumps => "jumps",
            Self::Wavy => "wavy",
            Self::Relay => "relay",
            Self::Saturating => "saturating",
            Self::Random => "random",
            Self::Convex => "convex",
            Self::DeadZone => "dead zone",
            Self::Flat => "flat",
        }
    }
}

/// Places at which curves are tabulated.
pub(super) const PLACES: usize = 161;

/// A middle and a half-width at [`PLACES`] even places of the interval.
#[derive(Debug, Clone)]
pub(super) struct Curves {
    pub kind: Kind,
    pub middle: Vec<f64>,
    pub half: Vec<f64>,
}

impl Curves {
    /// Draws both; the loop is 0.03 to 0.8 of the middle's slope wide, and it may have the other sense.
    pub(super) fn draw(rng: &mut ChaCha8Rng) -> Self {
        let kind = one_of(rng, &Kind::ALL);
        let middle = middle(kind, rng);
        let size = match kind {
            Kind::Flat => rng.random_range(0.3..0.8),
            _ => log_uniform(rng, 0.03, 0.8),
        };
        let sense = if rng.random_bool(0.85) { 1.0 } else { -1.0 };
        let half = widths(rng).into_iter().map(|w| sense * size * w).collect();
        Self { kind, middle, half }
    }
}

/// Places from −1 to 1.
pub(super) fn places() -> impl Iterator<Item = f64> {
    (0..PLACES).map(|i| 2.0 * i as f64 / (PLACES - 1) as f64 - 1.0)
}

fn middle(kind: Kind, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let k = rng.random_range(0.4..1.3) * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let along = |f: &mut dyn FnMut(f64) -> f64| places().map(f).collect::<Vec<f64>>();
    match kind {
        Kind::Straight => along(&mut |x| k * x),
        Kind::Cubic => {
            let c = rng.random_range(-0.25..0.7);
            along(&mut |x| k * (x + c * x * x * x))
        }
        Kind::Jumps => {
            let jumps: Vec<(f64, f64)> = (0..rng.random_range(1..4))
                .map(|_| (rng.random_range(-0.5..0.5), rng.random_range(-0.8..0.8)))
                .collect();
            along(&mut |x| k * x + jumps.iter().map(|(h, at)| if x > *at { *h } else { 0.0 }).sum::<f64>())
        }
        Kind::Wavy => {
            let (h, w, p) =
                (rng.random_range(0.05..0.35), rng.random_range(2.0..9.0), rng.random_range(0.0..TAU));
            along(&mut |x| k * x + h * (w * x + p).sin())
        }
        Kind::Relay => {
            let (at, width) = (rng.random_range(-0.5..0.5), log_uniform(rng, 0.005, 0.2));
            along(&mut |x| 0.25 * k * x + 0.7 * k.signum() * ((x - at) / width).tanh())
        }
        Kind::Saturating => {
            let (steep, at) = (rng.random_range(1.0..4.0), rng.random_range(-0.4..0.4));
            along(&mut |x| k * (steep * (x - at)).tanh())
        }
        Kind::Random => {
            let curve = smooth(rng);
            places().zip(curve).map(|(x, c)| 0.4 * k * x + 0.8 * c).collect()
        }
        Kind::Convex => {
            let power = rng.random_range(0.4..3.0);
            along(&mut |x| 2.0 * k * (0.5 * (x + 1.0)).powf(power))
        }
        Kind::DeadZone => {
            let d = rng.random_range(0.1..0.5);
            along(&mut |x| k * x.signum() * (x.abs() - d).max(0.0) + 0.05 * k * x)
        }
        Kind::Flat => along(&mut |x| 0.12 * k * x),
    }
}

/// The half-width along the interval, about one: constant, tilted, a lens that nearly closes, random, wide at the ends.
fn widths(rng: &mut ChaCha8Rng) -> Vec<f64> {
    match rng.random_range(0..5) {
        0 => vec![1.0; PLACES],
        1 => {
            let tilt = rng.random_range(-0.6..0.6);
            places().map(|x| 1.0 + tilt * x).collect()
        }
        2 => {
            let power = rng.random_range(0.3..1.2);
            places().map(|x| (1.0 - x * x).max(0.0).powf(power) + 0.02).collect()
        }
        3 => smooth(rng).into_iter().map(|c| 1.0 + 0.6 * c.clamp(-1.0, 1.0)).collect(),
        _ => places().map(|x| 0.5 + x * x).collect(),
    }
}

/// A smooth random curve of order one: cosines of falling weight.
pub(super) fn smooth(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let waves: Vec<(f64, f64)> = (1..=rng.random_range(3..8))
        .map(|k| (rng.random_range(-1.0..1.0) / f64::from(k).sqrt(), rng.random_range(0.0..TAU)))
        .collect();
    let at = |x: f64| {
        let wave = |(k, (h, p)): (usize, &(f64, f64))| h * (0.5 * PI * (k + 1) as f64 * x + p).cos();
        waves.iter().enumerate().map(wave).sum::<f64>()
    };
    places().map(at).collect()
}
