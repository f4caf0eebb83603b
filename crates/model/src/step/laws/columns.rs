//! What is added to the working point.

use super::builder::{Builder, Part, choose, note, when};
use super::motion::Motion;
use crate::step::model::{Column, Effects};
use crate::step::program::{Statement, Value, Variable};

/// What is added in a sample; nothing where there are no columns.
pub(super) fn part(b: &mut Builder, effects: &Effects, motion: &Motion) -> (Option<Variable>, Part) {
    let mut part = Part::default();
    if effects.columns.is_empty() {
        return (None, part);
    }
    let beside = b.state("beside", "what is added to the working point");
    part.start.push(beside.set(0.0));
    part.step.extend([note("what is added to the working point"), beside.set(0.0)]);
    for (number, (column, coefficient)) in effects.columns.iter().enumerate() {
        let held = b.state(&format!("added_{}", number + 1), says(column));
        part.start.push(held.set(0.0));
        part.step.extend(value(*column, held, motion));
        part.step.push(beside.set(beside + held * *coefficient));
    }
    (Some(beside), part)
}

fn says(column: &Column) -> &'static str {
    match column {
        Column::Speed { .. } => "a power of the speed",
        Column::LowSpeed { .. } => "what fades with the speed",
        Column::Bristle { .. } => "the bend of a bristle",
        Column::RestingLog { .. } | Column::RestingRise { .. } => "an after-effect at rest",
        Column::ReversalLog { .. } => "an after-effect of the last reversal",
        Column::Branch { .. } | Column::Side { .. } => "a change of one border",
    }
}

fn value(column: Column, held: Variable, motion: &Motion) -> Vec<Statement> {
    let branch = || motion.side();
    let change = motion.change.expect("effects have a motion");
    let speed = || change.get().abs();
    let fades = |power: f64, scale: f64| (-(speed() / scale).power(power)).exp();
    let moves = || change.get().differs(0.0);
    let unless_held = |is_held: bool, at_rest: Value| match is_held {
        true => Vec::new(),
        false => vec![held.set(at_rest)],
    };
    let at = |samples: Option<Variable>, scale: f64| {
        samples.expect("the motion has what columns ask for").get() / scale
    };
    match column {
        Column::Speed { power, scale, held: keeps } => {
            let moving = vec![held.set(branch() * (speed() / scale).power(power))];
            vec![choose(moves(), moving, unless_held(keeps, Value::from(0.0)))]
        }
        Column::LowSpeed { power, scale, held: keeps } => {
            vec![choose(
                moves(),
                vec![held.set(branch() * fades(power, scale))],
                unless_held(keeps, branch()),
            )]
        }
        Column::Bristle { power, scale, length } => {
            let aim = branch() * fades(power, scale);
            vec![held.set(held - (aim - held) * (-(speed() / length)).exp_m1())]
        }
        Column::RestingLog { scale } => vec![held.set(branch() * at(motion.rest, scale).ln_1p())],
        Column::ReversalLog { scale } => vec![held.set(branch() * at(motion.since, scale).ln_1p())],
        Column::RestingRise { scale } => {
            vec![held.set(branch() * -((-at(motion.rest, scale)).exp_m1()))]
        }
        Column::Branch { at } => vec![when(operator_moves(motion), vec![held.set(branch() * at)])],
        Column::Side { at, branch: side } => {
            let there = choose(branch().equals(side), vec![held.set(at)], vec![held.set(0.0)]);
            vec![when(operator_moves(motion), vec![there])]
        }
    }
}

fn operator_moves(motion: &Motion) -> crate::step::program::Condition {
    motion.moves().expect("effects have a motion")
}
