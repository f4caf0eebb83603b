//! A machine changed in one thing.

use super::row::Row;
use crate::generate::machine::multiply;
use crate::population::borders::places;
use crate::population::parts::{Mode, Parts};
use crate::population::random::log_uniform;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Sizes of changes as a share, evenly over the logarithm.
const SHARE: (f64, f64) = (0.01, 0.6);

/// Gives a machine what a row is about, where it lacks that.
pub(super) fn prepared(mut parts: Parts, row: Row, rng: &mut ChaCha8Rng) -> Parts {
    let oscillates = parts.modes.iter().any(|mode| matches!(mode, Mode::Oscillation { .. }));
    match row {
        Row::Damping | Row::Frequency if !oscillates => {
            let slowest = parts.slowest().max(2.0);
            let damping = rng.random_range(0.1..0.7);
            let frequency = (1.0 / (slowest * damping)).min(2.0);
            parts.modes = vec![Mode::Oscillation { frequency, damping }];
        }
        Row::TimeConstant if oscillates || parts.slowest() < 1.0 => {
            parts.modes = vec![Mode::Lag { time_constant: log_uniform(rng, 1.5, 40.0) }];
        }
        _ => {}
    }
    parts
}

/// The machine with another value of a row.
pub(super) fn changed(parts: &Parts, row: Row, rng: &mut ChaCha8Rng) -> Parts {
    let mut other = parts.clone();
    let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
    let share = side * log_uniform(rng, SHARE.0, SHARE.1);
    let range = {
        let curves = [&parts.curves.middle, &parts.curves.half];
        let span =
            |x: &[f64]| x.iter().fold(f64::MIN, |a, b| a.max(*b)) - x.iter().fold(f64::MAX, |a, b| a.min(*b));
        span(curves[0]) + 2.0 * curves[1].iter().fold(0.0, |a, b| f64::max(a, b.abs()))
    };
    match row {
        Row::Sign => other.gain = -other.gain,
        Row::Gain => other.gain *= share.exp(),
        Row::Offset => other.offset += share * range * parts.gain.abs(),
        Row::Delay => other.numerator = delayed(&parts.numerator, log_uniform(rng, 0.1, 5.0)),
        Row::TimeConstant => {
            if let Some(Mode::Lag { time_constant }) = other.modes.first_mut() {
                *time_constant *= share.exp();
            }
        }
        Row::Damping | Row::Frequency => {
            for mode in &mut other.modes {
                if let Mode::Oscillation { frequency, damping } = mode {
                    match row {
                        Row::Damping => *damping = (*damping * share.exp()).min(0.99),
                        _ => *frequency = (*frequency * (0.5 * share).exp()).min(2.8),
                    }
                }
            }
        }
        Row::Friction => other.curves.half.iter_mut().for_each(|h| *h *= share.exp()),
        Row::Stiffness => {
            other.curves.middle.iter_mut().zip(places()).for_each(|(m, x)| *m += 0.5 * share * range * x)
        }
        Row::Curvature => {
            let is_even = rng.random_bool(0.5);
            let bend = |x: f64| if is_even { x * x - 1.0 / 3.0 } else { x * x * x - 0.6 * x };
            other.curves.middle.iter_mut().zip(places()).for_each(|(m, x)| *m += share * range * bend(x));
        }
        Row::Order => {
            let time_constant = (parts.slowest() * rng.random_range(0.2..0.9)).max(0.4);
            other.modes.push(Mode::Lag { time_constant });
        }
        Row::Nothing | Row::Noise | Row::Effect => {}
    }
    other
}

fn delayed(numerator: &[f64], delay: f64) -> Vec<f64> {
    let part = delay.fract();
    let late = [vec![0.0; delay.floor() as usize], vec![1.0 - part, part]].concat();
    multiply(numerator, &late)
}

/// The value of a row, in the unit of [`Row`]; none of what a machine's parts do not hold.
pub(super) fn value(parts: &Parts, row: Row) -> Option<f64> {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let middle = &parts.curves.middle;
    let slope = {
        let square: f64 = places().map(|x| x * x).sum();
        middle.iter().zip(places()).map(|(m, x)| m * x).sum::<f64>() / square
    };
    let oscillation = parts.modes.iter().find_map(|mode| match *mode {
        Mode::Oscillation { frequency, damping } => Some((frequency, damping)),
        Mode::Lag { .. } => None,
    });
    Some(match row {
        Row::Nothing | Row::Noise | Row::Effect => return None,
        Row::Sign => parts.gain.signum(),
        Row::Gain => parts.gain,
        Row::Offset => parts.offset,
        Row::Delay => delay(&parts.numerator),
        Row::TimeConstant => match parts.modes.first()? {
            Mode::Lag { time_constant } => time_constant * parts.sample_time,
            Mode::Oscillation { .. } => return None,
        },
        Row::Damping => oscillation?.1,
        Row::Frequency => oscillation?.0 / parts.sample_time,
        Row::Friction => parts.gain * mean(&parts.curves.half),
        Row::Stiffness => parts.gain * slope * 2.0 / parts.interval.width(),
        Row::Curvature => {
            let centre = mean(middle);
            let bent =
                middle.iter().zip(places()).map(|(m, x)| (m - centre - slope * x).powi(2)).sum::<f64>();
            parts.gain.abs() * (bent / middle.len() as f64).sqrt()
        }
        Row::Order => parts.order() as f64,
    })
}

/// The centre of the numerator's weights: a delay in samples, but for a constant that both sides share.
fn delay(numerator: &[f64]) -> f64 {
    let sum: f64 = numerator.iter().sum();
    numerator.iter().enumerate().map(|(i, b)| i as f64 * b).sum::<f64>() / sum
}
