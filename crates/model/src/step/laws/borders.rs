//! The borders: their values, and the weights of their knots.

use super::builder::{Builder, choose, when};
use crate::step::model::{Beyond, Borders, Curve};
use crate::step::program::{Array, Procedure, Statement, Value, Variable};

/// A curve in the memory.
#[derive(Debug, Clone, Copy)]
pub(super) struct WrittenCurve {
    knots: Array,
    values: Array,
    size: usize,
    beyond: Beyond,
}

/// The borders in the memory.
#[derive(Debug, Clone, Copy)]
pub(super) enum Written {
    /// One curve for both directions.
    One(WrittenCurve),
    /// Descending, ascending.
    Two(WrittenCurve, WrittenCurve),
}

impl Written {
    pub(super) fn new(b: &mut Builder, borders: &Borders) -> Self {
        let mut write = |name: &str, curve: &Curve, says: &str| WrittenCurve {
            knots: b.constants(&format!("{name}_v"), &curve.knots, &format!("knots of {says}")),
            values: b.constants(&format!("{name}_u"), &curve.values, &format!("values of {says} there")),
            size: curve.knots.len(),
            beyond: curve.beyond,
        };
        match borders {
            Borders::One(curve) => Self::One(write("curve", curve, "the curve")),
            Borders::Two { descending, ascending } => {
                let descending = write("descending", descending, "the border of a falling input");
                Self::Two(descending, write("ascending", ascending, "the border of a rising input"))
            }
        }
    }

    /// Sets a variable to `u` at a position, on the border of a branch.
    pub(super) fn set(&self, u: Variable, branch: Value, at: &Value) -> Vec<Statement> {
        match self {
            Self::One(curve) => curve.set(u, at),
            Self::Two(descending, ascending) => {
                vec![choose(branch.more(0.0), ascending.set(u, at), descending.set(u, at))]
            }
        }
    }

    /// The same for a branch that is known beforehand.
    pub(super) fn set_on(&self, u: Variable, branch: f64, at: &Value) -> Vec<Statement> {
        match self {
            Self::One(curve) => curve.set(u, at),
            Self::Two(_, ascending) if branch > 0.0 => ascending.set(u, at),
            Self::Two(descending, _) => descending.set(u, at),
        }
    }

    /// Sets a variable to the mean over both borders at a position, where `rising` is the share of the ascending one; `other` is room.
    pub(super) fn set_mean(
        &self,
        (u, other): (Variable, Variable),
        rising: Value,
        at: &Value,
    ) -> Vec<Statement> {
        let mut body = self.set_on(u, 1.0, at);
        body.extend(self.set_on(other, -1.0, at));
        body.push(u.set((Value::from(1.0) - rising.clone()) * other + rising * u));
        body
    }

    /// Whether one of them is known at one point only.
    pub(super) fn has_gaps(&self) -> bool {
        let has_gaps = |curve: &WrittenCurve| matches!(curve.beyond, Beyond::Unknown(_));
        match self {
            Self::One(curve) => has_gaps(curve),
            Self::Two(descending, ascending) => has_gaps(descending) || has_gaps(ascending),
        }
    }

    /// All values in the order of the weights: descending, then ascending.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::One(curve) => curve.size,
            Self::Two(descending, ascending) => descending.size + ascending.size,
        }
    }

    /// The procedure `add_hat(side, at, factor)`: adds to `sum` the weights of the knots that carry a position on a border, times a factor.
    pub(super) fn add_hat(&self, b: &mut Builder, sum: Array) -> Procedure {
        let [side, at, factor] = ["side", "at", "factor"].map(|name| b.local(name));
        let (right, weight) = (b.index("right"), b.local("weight"));
        let on = |curve: &WrittenCurve, first: usize| curve.hat((right, weight), (sum, first), (at, factor));
        let body = match self {
            Self::One(curve) => on(curve, 0),
            Self::Two(descending, ascending) => {
                vec![choose(side.get().more(0.0), on(ascending, descending.size), on(descending, 0))]
            }
        };
        let says =
            "Adds to `sum` the weights of the two knots that carry a position on a border, times a factor.";
        b.procedure(("add_hat", says), &[side, at, factor], body)
    }
}

impl WrittenCurve {
    fn set(&self, u: Variable, at: &Value) -> Vec<Statement> {
        let Self { knots, values, .. } = *self;
        let end = |array: Array, k: usize| array.at(Value::Whole(k));
        match self.beyond {
            Beyond::Holds => vec![u.set(Value::Curve { knots, values, at: Box::new(at.clone()) })],
            Beyond::GoesOn => {
                let w = (at.clone() - end(knots, 0)) / (end(knots, 1) - end(knots, 0));
                vec![u.set(end(values, 0) + w * (end(values, 1) - end(values, 0)))]
            }
            Beyond::Unknown(within) => {
                let is_there = (at.clone() - end(knots, 0)).abs().at_most(within);
                vec![choose(is_there, vec![u.set(end(values, 0))], vec![u.set(Value::Nothing)])]
            }
        }
    }

    fn hat(
        &self,
        (right, weight): (Variable, Variable),
        (sum, first): (Array, usize),
        (at, factor): (Variable, Variable),
    ) -> Vec<Statement> {
        let knots = self.knots;
        let place = |k: Value| if first == 0 { k } else { k + Value::Whole(first) };
        let before = || right - Value::Whole(1);
        let add = |k: Value, x: Value| sum.put(place(k.clone()), sum.at(place(k)) + x);
        let (l, r) = (knots.at(before()), knots.at(right));
        let between = vec![
            weight.set((at - l.clone()) / (r - l)),
            add(before(), (Value::from(1.0) - weight) * factor),
            add(right.get(), weight * factor),
        ];
        let last = self.size - 1;
        vec![
            right.set(Value::Below(knots, Box::new(at.get()))),
            choose(
                right.get().equals(Value::Whole(0)),
                vec![add(Value::Whole(0), factor.get())],
                vec![choose(
                    right.get().more(Value::Whole(last)),
                    vec![add(Value::Whole(last), factor.get())],
                    between,
                )],
            ),
        ]
    }
}

/// Sets what is still no number to the value on the other border.
pub(super) fn or_other(borders: &Written, u: Variable, branch: Value, at: &Value) -> Statement {
    when(u.get().differs(u), borders.set(u, -branch, at))
}
