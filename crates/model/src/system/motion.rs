//! The motion of the position that acts: direction, speed, and the past since the last reversal.

use crate::derivative::{derivative, second_derivative};
use crate::hysteresis::Branch;
use crate::reversal::{Branches, ReversalRule};

/// One entry a sample each.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The position that acts.
    pub position: Vec<f64>,
    /// Direction, ±1, kept at rest; between these at a turning sample that both borders share.
    pub direction: Vec<f64>,
    /// Derivative of the position, input units a sample.
    pub velocity: Vec<f64>,
    /// Second derivative, input units a sample squared.
    pub acceleration: Vec<f64>,
    /// Samples by which the direction leads the velocity.
    pub lead: f64,
    /// Size of the last move, kept at rest.
    pub speed: Vec<f64>,
    /// Size of the move into this sample.
    pub moved: Vec<f64>,
    /// Samples since the last reversal.
    pub since: Vec<f64>,
    /// Samples of rest up to here.
    pub rest: Vec<f64>,
}

impl Motion {
    /// The motion of a position by a rule for reversals.
    pub fn of(position: &[f64], rule: ReversalRule) -> Self {
        let count = position.len();
        let at = |t: isize| position[t.clamp(0, count as isize - 1) as usize];
        let moved: Vec<f64> = (0..count as isize).map(|t| (at(t) - at(t - 1)).abs()).collect();
        // Noise on the position is no motion.
        let still = rule.threshold / 6.0;
        let (mut speed, mut rest) = (vec![0.0; count], vec![0.0; count]);
        for t in 1..count {
            let rests = moved[t] <= still;
            rest[t] = if rests { rest[t - 1] + 1.0 } else { 0.0 };
            speed[t] = if rests { speed[t - 1] } else { moved[t] };
        }
        let direction = directions(position, rule);
        let mut since = vec![0.0; count];
        for t in 1..count {
            since[t] = if direction[t] * direction[t - 1] < 0.0 { 0.0 } else { since[t - 1] + 1.0 };
        }
        let (velocity, acceleration) = (derivative(position), second_derivative(position));
        let position = position.to_vec();
        Self {
            position,
            direction,
            velocity,
            acceleration,
            lead: rule.timing.lead(),
            speed,
            moved,
            since,
            rest,
        }
    }
}

fn directions(position: &[f64], rule: ReversalRule) -> Vec<f64> {
    let Some(branches) = Branches::of(position, rule) else { return vec![1.0; position.len()] };
    let sign = |branch: &Branch| if *branch == Branch::Ascending { 1.0 } else { -1.0 };
    let labels = branches.labels().iter().map(sign).enumerate();
    // A position that rests before it turns stays on its border until it moves.
    let moved = |t: usize| t > 0 && position[t] != position[t - 1];
    let share = |t: usize| branches.turned(t).filter(|_| moved(t)).unwrap_or(0.0);
    labels.map(|(t, sign)| sign * (1.0 - 2.0 * share(t))).collect()
}
