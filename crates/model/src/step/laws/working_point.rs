//! The working point `u` on and between the borders.

use super::borders::{Written, or_other};
use super::builder::{Builder, Part, choose, note, when};
use super::by_border::by_border;
use super::input::Ends;
use super::motion::Motion;
use super::weights;
use crate::step::model::{Direction, Effects, Model};
use crate::step::program::{Value, Variable};

/// The working point, and how it is followed from the position `x`.
pub(super) fn part(
    b: &mut Builder,
    model: &Model,
    (ends, x): (&Ends, Variable),
    (borders, motion): (&Written, &Motion),
) -> (Variable, Part) {
    let Effects { jitter, transition, narrowing, widening, relaxation, .. } = &model.effects;
    let u = b.state("u", "the working point");
    let part = if *jitter > 0.0 {
        jittered(b, *jitter, (x, u), (borders, motion))
    } else if transition.is_some() || *narrowing != 0.0 || widening.is_some() || relaxation.is_some() {
        weights::part(b, model, (ends, x, u), (borders, motion))
    } else {
        on_borders(b, model.direction, (ends, x, u), (borders, motion))
    };
    (u, part)
}

/// It runs on the borders, and stays where it is while nothing moves.
fn on_borders(
    b: &mut Builder,
    direction: Direction,
    (ends, x, u): (&Ends, Variable, Variable),
    (borders, motion): (&Written, &Motion),
) -> Part {
    let on = |branch: f64| borders.set_on(u, branch, &x.get());
    let start = match (direction, borders) {
        (_, Written::One(_)) => on(1.0),
        (Direction::FirstMove { .. }, _) => borders.set(u, motion.side(), &x.get()),
        (Direction::Place { between_borders: true, .. }, _) => {
            let other = b.local("u_falling");
            by_border(ends, [on(-1.0), borders.set_mean((u, other), Value::from(0.5), &x.get()), on(1.0)])
        }
        (Direction::Place { .. }, _) => {
            let nearer = choose(Value::from(0.5).at_most(x), on(1.0), on(-1.0));
            by_border(ends, [on(-1.0), vec![nearer], on(1.0)])
        }
    };
    let gap = borders.has_gaps().then(|| or_other(borders, u, motion.side(), &x.get()));
    let on = borders.set(u, motion.side(), &x.get());
    let step = match motion.moves() {
        Some(moves) => vec![note("the working point"), when(moves, on)],
        None => on,
    };
    Part { start: start.into_iter().chain(gap).collect(), step }
}

/// The mean over both borders where noise on the position decides the branch: it rises with the probability
/// `½ erfc(−change/(2·jitter))`.
fn jittered(
    b: &mut Builder,
    jitter: f64,
    (x, u): (Variable, Variable),
    (borders, motion): (&Written, &Motion),
) -> Part {
    let other = b.local("u_falling");
    let mean = |rises: Value| borders.set_mean((u, other), rises, &x.get());
    let change = motion.change.expect("effects have a motion");
    let rises = b.local("rises");
    let probability = (change * -0.5 / jitter).erfc() * 0.5;
    let mut step = vec![note("noise on the position decides the border"), rises.set(probability)];
    step.extend(mean(rises.get()));
    Part { start: mean(Value::from(0.5)), step }
}
