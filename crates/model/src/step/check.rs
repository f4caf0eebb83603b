//! Whether a program is whole, before it runs.

use crate::step::program::{Array, Condition, Lives, Procedure, Program, Statement, Value, Variable};
use std::fmt;

/// Why a program cannot run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault(String);

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Fault {}

/// Most numbers in all arrays together, and most turns of a loop: what is beyond is a mistake in a file.
const LARGEST: usize = 10_000_000;

/// Checks that every reference has something to refer to, and that no procedure calls itself.
pub(crate) fn whole(program: &Program) -> Result<(), Fault> {
    let fault = |what: String| Err(Fault(what));
    let mut size = 0;
    for array in &program.arrays {
        size += array.length;
        let constants = array.constants.as_ref();
        if array.length == 0 || constants.is_some_and(|x| x.len() != array.length) || size > LARGEST {
            return fault(format!("the array `{}` has not the size that it says", array.name));
        }
    }
    let wanted = [2, 1];
    let entries = program.procedures.iter().rev().take(2).rev();
    if program.procedures.len() < 2 || entries.zip(wanted).any(|(card, count)| card.parameters.len() != count)
    {
        return fault("there is no `start(v, branch)` or no `step(v)`".to_owned());
    }
    let checker = |callable| Checker { program, callable };
    checker(0).variable(program.output)?;
    program.first_direction.map_or(Ok(()), |first_direction| checker(0).variable(first_direction))?;
    for (callable, card) in program.procedures.iter().enumerate() {
        let checker = checker(callable);
        card.parameters.iter().try_for_each(|parameter| checker.variable(*parameter))?;
        checker.body(&card.body)?;
    }
    Ok(())
}

/// Checks a procedure that may call those before it.
struct Checker<'a> {
    program: &'a Program,
    callable: usize,
}

impl Checker<'_> {
    fn variable(&self, Variable(place): Variable) -> Result<(), Fault> {
        match place < self.program.variables.len() {
            true => Ok(()),
            false => Err(Fault(format!("there is no variable {place}"))),
        }
    }

    fn array(&self, Array(place): Array) -> Result<usize, Fault> {
        let array = self.program.arrays.get(place);
        array.map(|array| array.length).ok_or_else(|| Fault(format!("there is no array {place}")))
    }

    fn kept(&self, array: Array) -> Result<(), Fault> {
        self.array(array)?;
        let card = &self.program.arrays[array.0];
        match card.constants {
            None => Ok(()),
            Some(_) => Err(Fault(format!("the constant array `{}` is written to", card.name))),
        }
    }

    fn body(&self, body: &[Statement]) -> Result<(), Fault> {
        body.iter().try_for_each(|statement| self.statement(statement))
    }

    fn statement(&self, statement: &Statement) -> Result<(), Fault> {
        match statement {
            Statement::Note(_) | Statement::Leave => Ok(()),
            Statement::Set(variable, value) => {
                self.variable(*variable)?;
                self.value(value)
            }
            Statement::Put(array, index, value) => {
                self.kept(*array)?;
                self.value(index)?;
                self.value(value)
            }
            Statement::Fill(array, value) | Statement::Push(array, value) => {
                self.kept(*array)?;
                self.value(value)
            }
            Statement::Copy(to, from) => {
                self.kept(*to)?;
                match to != from && self.array(*to)? == self.array(*from)? {
                    true => Ok(()),
                    false => Err(Fault("arrays of different lengths are copied".to_owned())),
                }
            }
            Statement::If(condition, then, otherwise) => {
                self.condition(condition)?;
                self.body(then)?;
                self.body(otherwise)
            }
            Statement::Repeat(index, count, body) => {
                self.variable(*index)?;
                if self.program.variables[index.0].lives != Lives::Index || *count > LARGEST {
                    return Err(Fault("a loop counts what is no index, or too far".to_owned()));
                }
                self.body(body)
            }
            Statement::Run(Procedure(place), parameters) => {
                let wanted = self.program.procedures.get(*place).map(|card| card.parameters.len());
                if *place >= self.callable || wanted != Some(parameters.len()) {
                    return Err(Fault(format!("the procedure {place} cannot be called from here")));
                }
                parameters.iter().try_for_each(|value| self.value(value))
            }
        }
    }

    fn condition(&self, condition: &Condition) -> Result<(), Fault> {
        match condition {
            Condition::Less(x, y)
            | Condition::AtMost(x, y)
            | Condition::Equal(x, y)
            | Condition::Differs(x, y) => {
                self.value(x)?;
                self.value(y)
            }
            Condition::Both(x, y) | Condition::Either(x, y) => {
                self.condition(x)?;
                self.condition(y)
            }
        }
    }

    fn value(&self, value: &Value) -> Result<(), Fault> {
        match value {
            Value::Number(_) | Value::Whole(_) | Value::Nothing => Ok(()),
            Value::Of(variable) => self.variable(*variable),
            Value::At(array, x) | Value::Below(array, x) => {
                self.array(*array)?;
                self.value(x)
            }
            Value::Call(_, x) => self.value(x),
            Value::Join(_, x, y) => {
                self.value(x)?;
                self.value(y)
            }
            Value::Dot(x, y) => self.array(*x).and(self.array(*y)).map(drop),
            Value::Curve { knots, values, at } => {
                if self.array(*knots)? != self.array(*values)? {
                    return Err(Fault("a curve has not as many knots as values".to_owned()));
                }
                self.value(at)
            }
        }
    }
}
