//! The input of all replicates, and what a border makes of it.

use crate::scenario::{Border, Case};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use switchback_identify::excitation::RandomLevels;
use switchback_identify::free::{Basis, Grid, Structure};
use switchback_model::hysteresis::{Branch, Interval, SwitchedHysteresis};
use switchback_model::linear::filter;
use switchback_model::reversal::{Branches, ReversalRule};

/// ChaCha stream of the drive, beyond those of any noise.
const STREAM: u64 = u64::MAX;

/// A border counts as piecewise linear on the knots where it departs from that by no more than this share of `u_M − u_m`.
const ROUNDING: f64 = 1e-9;

/// The program that drives every replicate: moves between random levels that begin at `h_m` and start over after `period` samples.
///
/// Every repetition excites the system alike, so information grows as `N` and the curves over `N` show the method, not the luck of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Program {
    pub(super) seed: u64,
    pub(super) period: usize,
}

/// The input for `samples` regression samples of the given order, and the past of the first.
pub(super) fn input(interval: Interval, program: Program, order: usize, samples: usize) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(program.seed);
    rng.set_stream(STREAM);
    let once = RandomLevels::new(interval).record_input(program.period - 1, &mut rng);
    // One sample loads the border, and n more are the past of the first that is explained.
    once.into_iter().cycle().take(1 + order + samples).collect()
}

/// `m` evenly spaced knots on each border, the ends of the interval among them.
pub(super) fn grid(interval: Interval, points: usize, order: usize) -> Grid {
    let last = (points - 1) as f64;
    let knot = |j: usize| match j {
        j if j + 1 == points => interval.high(),
        j => interval.low() + interval.width() * (j as f64 / last),
    };
    let knots: Vec<f64> = (0..points).map(knot).collect();
    Grid {
        structure: Structure { order, delay: 0 },
        basis: Basis::borders(knots.clone(), knots),
        rule: ReversalRule::EXACT,
    }
}

/// The noise-free output, from the steady state at `h_m` on.
///
/// The regression holds at every sample whatever the state it starts from, so there is no transient to drop.
pub(super) fn response(case: &Case, border: &Border, v: &[f64]) -> Vec<f64> {
    let before = border.hysteresis.u_low();
    let u = border.hysteresis.output(v, before);
    let (a, b) = (case.system.a(), case.system.b());
    filter(a, b, &u, &[], case.system.static_gain() * before, before)
}

/// Whether the borders are straight between the knots, wherever the drive goes.
pub(super) fn lies_on(hysteresis: &SwitchedHysteresis, grid: &Grid, v: &[f64]) -> bool {
    let Some(branches) = Branches::of(v, grid.rule) else { return false };
    let departure = |(&v, &branch): (&f64, &Branch)| {
        let knots = match branch {
            Branch::Descending => grid.basis.descending(),
            Branch::Ascending => grid.basis.ascending(),
        };
        let right = knots.partition_point(|&k| k <= v).clamp(1, knots.len() - 1);
        let (low, high) = (knots[right - 1], knots[right]);
        let share = (v - low) / (high - low);
        let [u_low, u_high] = [low, high].map(|knot| hysteresis.border(branch, knot));
        (hysteresis.border(branch, v) - u_low - share * (u_high - u_low)).abs()
    };
    let worst = v.iter().zip(branches.labels()).map(departure).fold(0.0, f64::max);
    worst <= ROUNDING * hysteresis.span()
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::hysteresis::{LeafSpring, Table, TablePoint};

    fn interval() -> Interval {
        Interval::new(-1.0, 1.0).expect("an interval")
    }

    #[test]
    fn the_drive_starts_over_after_its_period() {
        let program = Program { seed: 3, period: 100 };
        let v = input(interval(), program, 2, 250);
        assert_eq!(v.len(), 253);
        assert_eq!(v[..150], v[100..250]);
        assert_eq!(input(interval(), program, 2, 100)[..], v[..103]);
    }

    #[test]
    fn straight_pieces_lie_on_their_knots_and_on_no_others() {
        let table = |values: [f64; 3]| {
            [-1.0, 0.0, 1.0].into_iter().zip(values).map(|(v, u)| TablePoint { v, u }).collect()
        };
        let borders = Table::new(table([-0.4, 0.6, 0.9]), table([-0.8, -0.5, 0.7])).expect("borders");
        let corners = SwitchedHysteresis::new(interval(), Box::new(borders)).expect("Assumption 1");
        let spring = LeafSpring::hardening(0.6, 0.4, 0.3).expect("borders");
        let curved = SwitchedHysteresis::new(interval(), Box::new(spring)).expect("Assumption 1");
        let v = input(interval(), Program { seed: 1, period: 500 }, 2, 500);
        let lies = |hysteresis, points| lies_on(hysteresis, &grid(interval(), points, 2), &v);
        assert!(lies(&corners, 3) && lies(&corners, 5));
        assert!(!lies(&corners, 4) && !lies(&curved, 9));
    }
}
