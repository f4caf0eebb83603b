//! The linear part.

use super::builder::{Builder, Part, note, when};
use crate::step::model::Linear;
use crate::step::program::{Array, Procedure, Statement, Value, Variable};

/// Numbers below this are zero: what decays for ever must not slow the processor down.
const NOTHING: f64 = 1e-300;

/// The memory of the linear part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Past inputs of `B`, the latest in front.
    pub(super) u: Array,
    /// Past outputs before the sensor.
    z: Array,
    a: Array,
    b: Array,
    poles: Option<Array>,
    now: Variable,
}

impl Line {
    pub(super) fn new(b: &mut Builder, linear: &Linear) -> Self {
        let lagged = [vec![0.0; linear.lag], linear.b.clone()].concat();
        let memory = lagged.len().max(linear.poles.len());
        Self {
            u: b.line("past_u", memory, "inputs of the linear part, the latest first"),
            z: b.line("past_z", linear.a.len(), "outputs of the linear part, the latest first"),
            a: b.constants("a", &linear.a, "A, from lag 1"),
            b: b.constants("b", &lagged, "B, from lag 0"),
            poles: (!linear.poles.is_empty()).then(|| {
                b.constants("poles", &linear.poles, "denominator of the filter before B, from lag 1")
            }),
            now: b.local("z"),
        }
    }

    /// From the working point, what is added to it and the gain to the output.
    pub(super) fn part(
        &self,
        linear: &Linear,
        (u, beside, gain): (Variable, Option<Variable>, f64),
        read: Procedure,
    ) -> Part {
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        let z = self.now;
        let first = scaled(u.get(), gain / (1.0 + sum(&linear.poles)));
        let driven = raised(self.u.at(Value::Whole(0)) * sum(&linear.b), linear.constant);
        let rest = driven / (1.0 + sum(&linear.a));
        let mut start = vec![
            note("everything rests"),
            Statement::Fill(self.u, first),
            z.set(limited(rest, linear.limit)),
            Statement::Fill(self.z, z.get()),
        ];
        let acting = match beside {
            Some(beside) => u + beside,
            None => u.get(),
        };
        let acting = scaled(acting, gain);
        let mut step = vec![note("the linear part")];
        match self.poles {
            Some(poles) => step.extend([
                z.set(acting - Value::Dot(poles, self.u)),
                without_trace(z),
                Statement::Push(self.u, z.get()),
            ]),
            None => step.push(Statement::Push(self.u, acting)),
        }
        let driven = raised(Value::Dot(self.b, self.u) - Value::Dot(self.a, self.z), linear.constant);
        step.extend([
            z.set(limited(driven, linear.limit)),
            without_trace(z),
            Statement::Push(self.z, z.get()),
        ]);
        start.push(Statement::Run(read, vec![z.get()]));
        step.push(Statement::Run(read, vec![z.get()]));
        Part { start, step }
    }
}

fn scaled(value: Value, gain: f64) -> Value {
    if gain == 1.0 { value } else { value * gain }
}

fn raised(value: Value, by: f64) -> Value {
    if by == 0.0 { value } else { value + by }
}

fn limited(value: Value, limit: Option<f64>) -> Value {
    match limit {
        Some(limit) => value.within(-limit, limit),
        None => value,
    }
}

fn without_trace(z: Variable) -> Statement {
    when(z.get().abs().less(NOTHING), vec![z.set(0.0)])
}
