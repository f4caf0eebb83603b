//! Lays out a program's memory while its parts are written.

use crate::step::program::{
    Array, ArrayCard, Lives, Procedure, ProcedureCard, Program, Statement, Variable, VariableCard,
};

/// A program in the making.
#[derive(Debug, Default)]
pub(super) struct Builder {
    variables: Vec<VariableCard>,
    arrays: Vec<ArrayCard>,
    procedures: Vec<ProcedureCard>,
}

impl Builder {
    /// A number that lives from sample to sample.
    pub(super) fn state(&mut self, name: &str, says: &str) -> Variable {
        self.variable(name, Lives::State, says)
    }

    /// A number that lives in one procedure; none other has its name.
    pub(super) fn local(&mut self, name: &str) -> Variable {
        self.variable(name, Lives::Local, "")
    }

    /// A whole number that counts or points.
    pub(super) fn index(&mut self, name: &str) -> Variable {
        self.variable(name, Lives::Index, "")
    }

    fn variable(&mut self, name: &str, lives: Lives, says: &str) -> Variable {
        debug_assert!(self.variables.iter().all(|card| card.name != name), "{name} is there already");
        self.variables.push(VariableCard { name: name.to_owned(), lives, says: says.to_owned() });
        Variable(self.variables.len() - 1)
    }

    /// Numbers that never change.
    pub(super) fn constants(&mut self, name: &str, values: &[f64], says: &str) -> Array {
        self.array(name, values.len(), Some(values.to_vec()), says)
    }

    /// Numbers that live from sample to sample.
    pub(super) fn line(&mut self, name: &str, length: usize, says: &str) -> Array {
        self.array(name, length, None, says)
    }

    fn array(&mut self, name: &str, length: usize, constants: Option<Vec<f64>>, says: &str) -> Array {
        self.arrays.push(ArrayCard { name: name.to_owned(), length, constants, says: says.to_owned() });
        Array(self.arrays.len() - 1)
    }

    /// A procedure with its parameters.
    pub(super) fn procedure(
        &mut self,
        (name, says): (&str, &str),
        parameters: &[Variable],
        body: Vec<Statement>,
    ) -> Procedure {
        let (name, says) = (name.to_owned(), says.to_owned());
        self.procedures.push(ProcedureCard { name, says, parameters: parameters.to_vec(), body });
        Procedure(self.procedures.len() - 1)
    }

    /// The program, whose last two procedures are `start` and `step`.
    pub(super) fn finish(self, output: Variable, first_direction: Option<Variable>, direct: bool) -> Program {
        let Self { variables, arrays, procedures } = self;
        Program { variables, arrays, procedures, output, first_direction, direct }
    }
}

/// What a part does when a run begins, and in a step.
#[derive(Debug, Default)]
pub(super) struct Part {
    pub(super) start: Vec<Statement>,
    pub(super) step: Vec<Statement>,
}

/// Words for the reader.
pub(super) fn note(text: &str) -> Statement {
    Statement::Note(text.to_owned())
}

/// One of two branches.
pub(super) fn choose(
    condition: crate::step::program::Condition,
    then: Vec<Statement>,
    otherwise: Vec<Statement>,
) -> Statement {
    Statement::If(condition, then, otherwise)
}

/// A branch or nothing.
pub(super) fn when(condition: crate::step::program::Condition, then: Vec<Statement>) -> Statement {
    Statement::If(condition, then, Vec::new())
}
