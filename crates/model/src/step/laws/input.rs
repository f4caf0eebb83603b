//! From what comes in to a position on the model's scale.

use super::builder::{Builder, Part, choose, note, when};
use crate::step::model::{Model, Scale};
use crate::step::program::{Value, Variable};

/// What a program takes and gives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    /// The input.
    pub(super) v: Variable,
    /// The border on which a run begins.
    pub(super) branch: Variable,
    /// The output.
    pub(super) output: Variable,
}

impl Ends {
    pub(super) fn new(b: &mut Builder) -> Self {
        let output = b.state("y", "the output");
        Self { v: b.local("v"), branch: b.local("border"), output }
    }
}

/// The position that acts.
pub(super) fn part(b: &mut Builder, model: &Model, ends: &Ends) -> (Variable, Part) {
    let finite = b.state("v_last", "the last finite input");
    let x = b.local("x");
    let v = ends.v;
    // What is not finite gives no number here.
    let is_finite = || (v * 0.0).equals(0.0);
    let mut part = Part {
        start: vec![
            choose(is_finite(), vec![finite.set(v)], vec![finite.set(model.input.origin)]),
            x.set(scaled(finite.get(), &model.input)),
        ],
        step: vec![when(is_finite(), vec![finite.set(v)]), x.set(scaled(finite.get(), &model.input))],
    };
    if model.late > 0.0 {
        let before = b.state("x_recorded", "the last recorded position");
        let now = b.local("x_now");
        part.start.push(before.set(x));
        part.step.extend([
            note("what acts lies between the last two positions"),
            now.set(x),
            x.set(now + Value::from(model.late) * (before - now)),
            before.set(now),
        ]);
    }
    (x, part)
}

fn scaled(v: Value, scale: &Scale) -> Value {
    let x = if scale.is_none() { v } else { (v - scale.origin) / scale.size };
    match scale.grid {
        Some(grid) => (x / grid).round() * grid,
        None => x,
    }
}
