//! Runs a program.

use crate::step::check::{self, Fault};
use crate::step::program::{
    Array, Condition, Function, Operation, Procedure, Program, Statement, Value, Variable,
};
use std::ops::ControlFlow;
use std::sync::Arc;

/// A program with its memory.
#[derive(Debug, Clone)]
pub struct Machine {
    program: Arc<Program>,
    memory: Memory,
}

/// All that changes while a program runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    numbers: Vec<f64>,
    /// Constants, too: what is read is in one place.
    arrays: Vec<Vec<f64>>,
}

impl Machine {
    /// Makes room for a program. It runs after [`Self::start`].
    ///
    /// # Errors
    /// [`Fault`] where the program refers to what it does not have, or runs in a circle.
    pub fn new(program: Arc<Program>) -> Result<Self, Fault> {
        check::whole(&program)?;
        let filled =
            program.arrays.iter().map(|a| a.constants.clone().unwrap_or_else(|| vec![0.0; a.length]));
        let memory = Memory { numbers: vec![0.0; program.variables.len()], arrays: filled.collect() };
        Ok(Self { program, memory })
    }

    /// The program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Begins a run at rest at an input, as if that had always been there: on the ascending border for a `branch` of +1, on the descending
    /// one for −1; for 0 where the model begins by itself, see [`Program::first_direction`].
    pub fn start(&mut self, v: f64, branch: f64) {
        self.call(self.program.start(), &[v, branch]);
    }

    /// The output after one more sample of the input. An input that is not finite counts as the one before.
    pub fn step(&mut self, v: f64) -> f64 {
        self.call(self.program.step(), &[v]);
        self.output()
    }

    /// The last output; that of rest after a start.
    pub fn output(&self) -> f64 {
        self.memory.numbers[self.program.output.0]
    }

    /// The first direction of the input: ±1, 0 while it is unknown. None where no run depends on it.
    pub fn first_direction(&self) -> Option<f64> {
        self.program.first_direction.map(|variable| self.memory.numbers[variable.0])
    }

    /// The memory, to come back to it.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Comes back to a memory of the same program.
    pub fn restore(&mut self, memory: Memory) {
        self.memory = memory;
    }

    fn call(&mut self, procedure: Procedure, parameters: &[f64]) {
        let program = Arc::clone(&self.program);
        let card = &program.procedures[procedure.0];
        for (variable, x) in card.parameters.iter().zip(parameters) {
            self.memory.numbers[variable.0] = *x;
        }
        let _ = self.memory.run(&program, &card.body);
    }
}

impl Memory {
    /// `Break` where a loop is left.
    fn run(&mut self, program: &Program, body: &[Statement]) -> ControlFlow<()> {
        for statement in body {
            match statement {
                Statement::Note(_) => {}
                Statement::Set(variable, value) => self.numbers[variable.0] = self.value(value),
                Statement::Put(array, index, value) => {
                    let (at, value) = (self.value(index), self.value(value));
                    if let Some(place) = self.arrays[array.0].get_mut(at as usize) {
                        *place = value;
                    }
                }
                Statement::Fill(array, value) => {
                    let value = self.value(value);
                    self.arrays[array.0].fill(value);
                }
                Statement::Copy(to, from) => {
                    let [to, from] = self.arrays.get_disjoint_mut([to.0, from.0]).expect("checked");
                    to.copy_from_slice(from);
                }
                Statement::Push(array, value) => {
                    let value = self.value(value);
                    let line = &mut self.arrays[array.0];
                    let last = line.len() - 1;
                    line.copy_within(..last, 1);
                    line[0] = value;
                }
                Statement::If(condition, then, otherwise) => {
                    self.run(program, if self.holds(condition) { then } else { otherwise })?;
                }
                Statement::Repeat(index, count, body) => {
                    for k in 0..*count {
                        self.numbers[index.0] = k as f64;
                        if self.run(program, body).is_break() {
                            break;
                        }
                    }
                }
                Statement::Leave => return ControlFlow::Break(()),
                Statement::Run(procedure, parameters) => {
                    let card = &program.procedures[procedure.0];
                    for (variable, value) in card.parameters.iter().zip(parameters) {
                        self.numbers[variable.0] = self.value(value);
                    }
                    let _ = self.run(program, &card.body);
                }
            }
        }
        ControlFlow::Continue(())
    }

    fn value(&self, value: &Value) -> f64 {
        match value {
            Value::Number(x) => *x,
            Value::Whole(k) => *k as f64,
            Value::Nothing => f64::NAN,
            Value::Of(Variable(place)) => self.numbers[*place],
            Value::At(array, index) => {
                self.array(array).get(self.value(index) as usize).copied().unwrap_or(f64::NAN)
            }
            Value::Call(function, x) => function.of(self.value(x)),
            Value::Join(operation, x, y) => operation.of(self.value(x), self.value(y)),
            Value::Dot(x, y) => self.array(x).iter().zip(self.array(y)).map(|(x, y)| x * y).sum(),
            Value::Below(array, x) => below(self.array(array), self.value(x)) as f64,
            Value::Curve { knots, values, at } => {
                curve(self.array(knots), self.array(values), self.value(at))
            }
        }
    }

    fn array(&self, array: &Array) -> &[f64] {
        &self.arrays[array.0]
    }

    fn holds(&self, condition: &Condition) -> bool {
        match condition {
            Condition::Less(x, y) => self.value(x) < self.value(y),
            Condition::AtMost(x, y) => self.value(x) <= self.value(y),
            Condition::Equal(x, y) => self.value(x) == self.value(y),
            Condition::Differs(x, y) => self.value(x) != self.value(y),
            Condition::Both(x, y) => self.holds(x) && self.holds(y),
            Condition::Either(x, y) => self.holds(x) || self.holds(y),
        }
    }
}

fn below(knots: &[f64], x: f64) -> usize {
    knots.partition_point(|knot| *knot < x)
}

fn curve(knots: &[f64], values: &[f64], x: f64) -> f64 {
    let right = below(knots, x);
    let last = values.len() - 1;
    if right == 0 {
        return values[0];
    }
    if right > last {
        return values[last];
    }
    let (l, r) = (knots[right - 1], knots[right]);
    let w = (x - l) / (r - l);
    (1.0 - w) * values[right - 1] + w * values[right]
}

impl Function {
    fn of(self, x: f64) -> f64 {
        match self {
            Self::Abs => x.abs(),
            Self::Exp => x.exp(),
            Self::ExpM1 => x.exp_m1(),
            Self::Log1P => x.ln_1p(),
            Self::Erfc => libm::erfc(x),
            Self::Round => x.round(),
        }
    }
}

impl Operation {
    fn of(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Add => x + y,
            Self::Subtract => x - y,
            Self::Multiply => x * y,
            Self::Divide => x / y,
            Self::Power => x.powf(y),
            // The left one where one is no number: C does the same.
            Self::Least => {
                if y < x {
                    y
                } else {
                    x
                }
            }
            Self::Greatest => {
                if x < y {
                    y
                } else {
                    x
                }
            }
        }
    }
}
