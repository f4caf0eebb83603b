//! What laws need to know of the input's motion.

use crate::generate::machine::Machine;
use switchback_model::hysteresis::Branch;

/// Direction of the last move at every sample: +1 rising, −1 falling. A passage starts loaded at a satellite.
pub(crate) fn directions(machine: &Machine, v: &[f64]) -> Vec<f64> {
    let mut direction =
        if v[0] > 0.5 * (machine.interval.low() + machine.interval.high()) { 1.0 } else { -1.0 };
    let mut last = v[0];
    v.iter()
        .map(|&now| {
            if now != last {
                direction = if now > last { 1.0 } else { -1.0 };
            }
            last = now;
            direction
        })
        .collect()
}

/// Moves `v(t) − v(t−1)` in units of the interval's width; the first is zero.
pub(super) fn moves(machine: &Machine, v: &[f64]) -> Vec<f64> {
    let width = machine.interval.width();
    (0..v.len()).map(|t| if t == 0 { 0.0 } else { (v[t] - v[t - 1]) / width }).collect()
}

/// The moves with every rest given the move before it.
pub(super) fn last_moves(machine: &Machine, v: &[f64]) -> Vec<f64> {
    let mut last = 0.0;
    moves(machine, v)
        .into_iter()
        .map(|now| {
            if now != 0.0 {
                last = now;
            }
            last
        })
        .collect()
}

/// Samples since the last reversal.
pub(super) fn since_reversal(directions: &[f64]) -> Vec<f64> {
    let mut count = 0.0;
    (0..directions.len())
        .map(|t| {
            count = if t > 0 && directions[t] != directions[t - 1] { 0.0 } else { count + 1.0 };
            count
        })
        .collect()
}

/// Position in the interval, 0 at `h_m` and 1 at `h_M`.
pub(super) fn position(machine: &Machine, v: f64) -> f64 {
    (v - machine.interval.low()) / machine.interval.width()
}

/// Half the distance between the borders at `v`, positive where the ascending one lies above.
pub(super) fn half_width(machine: &Machine, v: f64) -> f64 {
    let border = |branch| machine.hysteresis.border(branch, v);
    0.5 * (border(Branch::Ascending) - border(Branch::Descending))
}

/// The border that a direction runs on, at `v`.
pub(super) fn border(machine: &Machine, direction: f64, v: f64) -> f64 {
    machine.hysteresis.border(if direction > 0.0 { Branch::Ascending } else { Branch::Descending }, v)
}
