//! How the input moves, as the operator sees it.

use super::borders::Written;
use super::builder::{Builder, Part, choose, note, when};
use super::input::Ends;
use crate::step::model::{Borders, Column, Direction, Effects, Model, Play};
use crate::step::program::{Array, Condition, Statement, Value, Variable};

/// What the other laws ask of the motion; none where nobody asks.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Motion {
    /// +1 on the ascending border, −1 on the descending one, 0 before the first move.
    pub(super) branch: Option<Variable>,
    /// The change of the position in this sample.
    pub(super) change: Option<Variable>,
    /// The change behind the play; the operator moves where it is not zero.
    pub(super) push: Option<Variable>,
    /// 1 in a sample in which a new branch begins.
    pub(super) reversal: Option<Variable>,
    /// The position at the last reversal.
    pub(super) turn: Option<Variable>,
    /// Travel since then.
    pub(super) travel: Option<Variable>,
    /// Samples since then.
    pub(super) since: Option<Variable>,
    /// Samples since the last change.
    pub(super) rest: Option<Variable>,
    /// The first direction.
    pub(super) first_direction: Option<Variable>,
}

impl Motion {
    /// Whether the operator moves in this sample; always where nobody asked.
    pub(super) fn moves(&self) -> Option<Condition> {
        self.push.map(|push| push.get().differs(0.0))
    }

    /// The branch, where two borders ask for it.
    pub(super) fn side(&self) -> Value {
        self.branch.map_or(Value::Number(1.0), Variable::get)
    }
}

/// Follows the position `x`; `u` is the line of past `u` with the latest in front.
pub(super) fn part(
    b: &mut Builder,
    model: &Model,
    (ends, x): (&Ends, Variable),
    (borders, u): (&Written, Array),
) -> (Motion, Part) {
    match (model.direction, &model.borders) {
        (Direction::FirstMove { .. }, Borders::One(_)) => (Motion::default(), Part::default()),
        (Direction::FirstMove { threshold, between_samples }, Borders::Two { .. }) => {
            let shared = between_samples.then_some((borders, u));
            first_move(b, threshold, (ends, x), shared)
        }
        (Direction::Place { threshold, play, .. }, _) => placed(b, &model.effects, x, (threshold, play)),
    }
}

/// The direction is unknown until the input has moved by more than the threshold.
fn first_move(
    b: &mut Builder,
    threshold: f64,
    (ends, x): (&Ends, Variable),
    shared: Option<(&Written, Array)>,
) -> (Motion, Part) {
    let last = b.state("x_last", "the last position");
    let branch = b.state("branch", "+1 on the ascending border, -1 on the descending one");
    let first_direction =
        b.state("first_direction", "the first direction of the input: +1, -1, or 0 while it is unknown");
    let extreme = b.state("extreme", "the furthest position of this branch");
    let low = b.state("lowest", "the lowest position while the direction is unknown");
    let change = b.local("change");
    let mut start = vec![
        choose(ends.branch.get().less(0.0), vec![branch.set(-1.0)], vec![branch.set(1.0)]),
        first_direction.set(0.0),
        extreme.set(x),
        low.set(x),
        last.set(x),
    ];
    let turns_to = |side: f64| vec![first_direction.set(side), branch.set(side), extreme.set(x)];
    let unknown = vec![
        extreme.set(extreme.get().greatest(x)),
        low.set(low.get().least(x)),
        choose(
            (extreme - x).more(threshold),
            turns_to(-1.0),
            vec![when((x - low).more(threshold), turns_to(1.0))],
        ),
    ];
    let mut reversal = Vec::new();
    let mut after = vec![last.set(x)];
    if let Some((borders, u)) = shared {
        let before = b.state("x_before", "the position before the last one");
        start.push(before.set(x));
        reversal = share_turn(b, (borders, u), branch, [before, last, x]);
        after.insert(0, before.set(last));
    }
    reversal.extend([branch.set(-branch.get()), extreme.set(x)]);
    let known = vec![choose(
        ((extreme - x) * branch).more(threshold),
        reversal,
        vec![when(((extreme - x) * branch).less(0.0), vec![extreme.set(x)])],
    )];
    let mut step = vec![
        note("the direction of the input"),
        change.set(x - last),
        choose(first_direction.get().equals(0.0), unknown, known),
    ];
    step.extend(after);
    let motion = Motion {
        branch: Some(branch),
        change: Some(change),
        push: Some(change),
        first_direction: Some(first_direction),
        ..Motion::default()
    };
    (motion, Part { start, step })
}

/// The reversal lies at the vertex of the parabola through the last three positions: the turning sample is shared between the borders by
/// the part of its interval that follows.
fn share_turn(
    b: &mut Builder,
    (borders, u): (&Written, Array),
    branch: Variable,
    [before, at, after]: [Variable; 3],
) -> Vec<Statement> {
    let (offset, own, next) = (b.local("offset"), b.local("own"), b.local("next"));
    let curvature = before - Value::from(2.0) * at + after;
    let mut body = vec![
        note("the turning sample is shared between the borders"),
        offset.set((Value::from(0.5) * (before - after) / curvature).within(-0.5, 0.5)),
    ];
    body.extend(borders.set(own, branch.get(), &at.get()));
    body.extend(borders.set(next, -branch.get(), &at.get()));
    body.push(u.put(Value::Whole(0), own + (Value::from(0.5) - offset) * (next - own)));
    body
}

/// The operator is pushed through a play, and every first move gives a branch.
fn placed(b: &mut Builder, effects: &Effects, x: Variable, (threshold, play): (f64, Play)) -> (Motion, Part) {
    let asks = |is: fn(&Column) -> bool| effects.columns.iter().any(|(column, _)| is(column));
    let asks_rest = asks(|c| matches!(c, Column::RestingLog { .. } | Column::RestingRise { .. }));
    let asks_since = asks(|c| matches!(c, Column::ReversalLog { .. }));
    let turns = effects.transition.is_some();
    let last = b.state("x_last", "the last position");
    let branch =
        b.state("branch", "+1 on the ascending border, -1 on the descending one, 0 before the first move");
    let extreme = b.state("extreme", "the furthest position of this branch");
    let change = b.local("change");
    let mut motion =
        Motion { branch: Some(branch), change: Some(change), push: Some(change), ..Motion::default() };
    let mut start = vec![last.set(x), branch.set(0.0), extreme.set(x)];
    let mut step = vec![note("how the operator moves")];
    if play.width == 0.0 || asks_rest || asks_speed(effects) {
        step.push(change.set(x - last));
    }
    step.push(last.set(x));
    let (mut place, mut push) = (x, change);
    if play.width != 0.0 {
        push = b.local("push");
        motion.push = Some(push);
        place = b.state("pushed", "where the input has pushed the operator to, behind the play");
        let (half, to) = (b.local("half"), b.local("pushed_to"));
        start.push(place.set(x));
        let wide = Value::from(play.taper) * (Value::from(2.0) * x - 1.0) + 1.0;
        step.extend([
            half.set(wide.greatest(0.0) * (0.5 * play.width)),
            to.set(place.get().greatest(x - half).least(x + half)),
            push.set(to - place),
            place.set(to),
        ]);
    }
    let mut turning = vec![choose(push.get().more(0.0), vec![branch.set(1.0)], vec![branch.set(-1.0)])];
    let mut moved = Vec::new();
    if turns || asks_since {
        let reversal = b.local("reversal");
        motion.reversal = Some(reversal);
        step.push(reversal.set(0.0));
        turning.push(reversal.set(1.0));
    }
    if turns {
        let turn = b.state("turn", "the position at the last reversal");
        let travel = b.state("travel", "how far the operator has moved since then");
        (motion.turn, motion.travel) = (Some(turn), Some(travel));
        start.extend([turn.set(x), travel.set(0.0)]);
        turning.push(turn.set(extreme));
        moved.push(travel.set((place - turn).abs()));
    }
    turning.push(extreme.set(place));
    let back = b.local("back");
    let begins = branch.get().equals(0.0).or(back.get().more(threshold));
    let mut moving = vec![
        back.set((extreme - place) * branch),
        choose(begins, turning, vec![when(back.get().at_most(0.0), vec![extreme.set(place)])]),
    ];
    moving.extend(moved);
    step.push(when(push.get().differs(0.0), moving));
    if let Some(reversal) = motion.reversal.filter(|_| asks_since) {
        let since = b.state("since", "samples since the last reversal");
        motion.since = Some(since);
        start.push(since.set(0.0));
        step.push(choose(reversal.get().differs(0.0), vec![since.set(0.0)], vec![since.set(since + 1.0)]));
    }
    if asks_rest {
        let rest = b.state("rest", "samples since the input last moved");
        motion.rest = Some(rest);
        start.push(rest.set(0.0));
        step.push(choose(change.get().equals(0.0), vec![rest.set(rest + 1.0)], vec![rest.set(0.0)]));
    }
    (motion, Part { start, step })
}

/// Whether an effect asks how fast the input moves.
fn asks_speed(effects: &Effects) -> bool {
    let asks = |(column, _): &(Column, f64)| {
        matches!(column, Column::Speed { .. } | Column::LowSpeed { .. } | Column::Bristle { .. })
    };
    effects.jitter > 0.0 || effects.widening.is_some() || effects.columns.iter().any(asks)
}
