//! A small program of assignments on a fixed memory: what a causal model does in one sample.
//!
//! It has numbers, fixed arrays, branches and counted loops: all that C and the interpreter [`Machine`](crate::step::Machine) share. Its size, and
//! the most it does in a step, are known before it runs.

use serde::{Deserialize, Serialize};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number in the memory, by its place among [`Program::variables`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Variable(pub(crate) usize);

/// An array, by its place among [`Program::arrays`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Array(pub(crate) usize);

/// A procedure, by its place among [`Program::procedures`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Procedure(pub(crate) usize);

/// Where a variable lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Lives {
    /// From sample to sample.
    State,
    /// In one call of one procedure.
    Local,
    /// The same, a whole number that counts or points into an array.
    Index,
}

/// A variable's name and what it means.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VariableCard {
    /// A word that is none of C's.
    pub name: String,
    /// Where it lives.
    pub lives: Lives,
    /// What it is, in words; empty for a local one.
    pub says: String,
}

/// An array's name, size and, where it never changes, its contents.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ArrayCard {
    /// A word that is none of C's.
    pub name: String,
    /// Its numbers.
    pub length: usize,
    /// The numbers themselves where they are constants; otherwise it lives from sample to sample.
    pub constants: Option<Vec<f64>>,
    /// What it is, in words.
    pub says: String,
}

/// A procedure: parameters, which live in its call, and what it does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProcedureCard {
    /// A word that is none of C's.
    pub name: String,
    /// What it does, in words.
    pub says: String,
    /// Locals that the caller sets.
    pub parameters: Vec<Variable>,
    /// What it does.
    pub body: Vec<Statement>,
}

/// A causal model as a program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// All numbers.
    pub variables: Vec<VariableCard>,
    /// All arrays.
    pub arrays: Vec<ArrayCard>,
    /// All procedures; one calls only those before it. The last two are `start(v, branch)` and `step(v)`.
    pub procedures: Vec<ProcedureCard>,
    /// Holds the output after a step.
    pub output: Variable,
    /// 0 until the input has shown its direction, then ±1, the first one. None where a run begins at a border by the place of the input.
    pub first_direction: Option<Variable>,
    /// Whether the output of a sample depends on the input of the same sample.
    pub direct: bool,
}

/// A function of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Function {
    /// `|x|`.
    Abs,
    /// `eˣ`.
    Exp,
    /// `eˣ − 1`.
    ExpM1,
    /// `ln(1 + x)`.
    Log1P,
    /// The complementary error function.
    Erfc,
    /// To the nearest whole number, halves away from zero.
    Round,
}

/// An operation on two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    /// `x + y`.
    Add,
    /// `x − y`.
    Subtract,
    /// `x·y`.
    Multiply,
    /// `x/y`.
    Divide,
    /// `xʸ`.
    Power,
    /// The smaller one.
    Least,
    /// The greater one.
    Greatest,
}

/// A number that is computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Value {
    /// A constant, finite.
    Number(f64),
    /// A whole constant, among indices.
    Whole(usize),
    /// No number: what follows from an input of which the model knows nothing.
    Nothing,
    /// A variable.
    Of(Variable),
    /// An element of an array.
    At(Array, Box<Value>),
    /// A function of a number.
    Call(Function, Box<Value>),
    /// Two numbers joined.
    Join(Operation, Box<Value>, Box<Value>),
    /// `Σ xₖ yₖ` over the shorter of two arrays.
    Dot(Array, Array),
    /// Elements of an increasing array that are smaller than a number.
    Below(Array, Box<Value>),
    /// The curve through points `(xₖ, yₖ)`, straight between them and constant beyond; at a jump, an `x` that stands twice, the left value.
    Curve {
        /// Increasing `x`.
        knots: Array,
        /// As many `y`.
        values: Array,
        /// Where.
        at: Box<Value>,
    },
}

/// What may hold or not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// `x < y`.
    Less(Value, Value),
    /// `x ≤ y`.
    AtMost(Value, Value),
    /// `x = y`.
    Equal(Value, Value),
    /// `x ≠ y`, or one is no number.
    Differs(Value, Value),
    /// Both.
    Both(Box<Condition>, Box<Condition>),
    /// One at least.
    Either(Box<Condition>, Box<Condition>),
}

/// A step of a program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Statement {
    /// Words for the reader.
    Note(String),
    /// A variable takes a value.
    Set(Variable, Value),
    /// An element of an array takes a value.
    Put(Array, Value, Value),
    /// All elements of an array take a value.
    Fill(Array, Value),
    /// An array takes the values of another of the same length.
    Copy(Array, Array),
    /// A value goes in front of an array, whose last one is lost.
    Push(Array, Value),
    /// One of two branches.
    If(Condition, Vec<Statement>, Vec<Statement>),
    /// So many times, with an index from 0.
    Repeat(Variable, usize, Vec<Statement>),
    /// Leaves the innermost loop.
    Leave,
    /// Runs a procedure with these parameters.
    Run(Procedure, Vec<Value>),
}

impl Program {
    /// The procedure that begins a run, `start(v, branch)`.
    pub(crate) fn start(&self) -> Procedure {
        Procedure(self.procedures.len() - 2)
    }

    /// The procedure of a sample, `step(v)`.
    pub(crate) fn step(&self) -> Procedure {
        Procedure(self.procedures.len() - 1)
    }
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<Variable> for Value {
    fn from(x: Variable) -> Self {
        Self::Of(x)
    }
}

impl Value {
    /// A function of it.
    fn call(self, function: Function) -> Self {
        Self::Call(function, Box::new(self))
    }

    fn join(self, operation: Operation, other: impl Into<Value>) -> Self {
        Self::Join(operation, Box::new(self), Box::new(other.into()))
    }

    pub(crate) fn abs(self) -> Self {
        self.call(Function::Abs)
    }

    pub(crate) fn exp(self) -> Self {
        self.call(Function::Exp)
    }

    pub(crate) fn exp_m1(self) -> Self {
        self.call(Function::ExpM1)
    }

    pub(crate) fn ln_1p(self) -> Self {
        self.call(Function::Log1P)
    }

    pub(crate) fn erfc(self) -> Self {
        self.call(Function::Erfc)
    }

    pub(crate) fn round(self) -> Self {
        self.call(Function::Round)
    }

    pub(crate) fn power(self, exponent: f64) -> Self {
        self.join(Operation::Power, exponent)
    }

    pub(crate) fn least(self, other: impl Into<Value>) -> Self {
        self.join(Operation::Least, other)
    }

    pub(crate) fn greatest(self, other: impl Into<Value>) -> Self {
        self.join(Operation::Greatest, other)
    }

    pub(crate) fn within(self, low: f64, high: f64) -> Self {
        let above = if low.is_finite() { self.greatest(low) } else { self };
        if high.is_finite() { above.least(high) } else { above }
    }

    pub(crate) fn less(self, other: impl Into<Value>) -> Condition {
        Condition::Less(self, other.into())
    }

    pub(crate) fn more(self, other: impl Into<Value>) -> Condition {
        Condition::Less(other.into(), self)
    }

    pub(crate) fn at_most(self, other: impl Into<Value>) -> Condition {
        Condition::AtMost(self, other.into())
    }

    pub(crate) fn equals(self, other: impl Into<Value>) -> Condition {
        Condition::Equal(self, other.into())
    }

    pub(crate) fn differs(self, other: impl Into<Value>) -> Condition {
        Condition::Differs(self, other.into())
    }
}

impl Condition {
    pub(crate) fn and(self, other: Condition) -> Self {
        Self::Both(Box::new(self), Box::new(other))
    }

    pub(crate) fn or(self, other: Condition) -> Self {
        Self::Either(Box::new(self), Box::new(other))
    }
}

impl Variable {
    /// Its value.
    pub(crate) fn get(self) -> Value {
        Value::Of(self)
    }

    /// It takes a value.
    pub(crate) fn set(self, value: impl Into<Value>) -> Statement {
        Statement::Set(self, value.into())
    }
}

impl Array {
    /// An element.
    pub(crate) fn at(self, index: impl Into<Value>) -> Value {
        Value::At(self, Box::new(index.into()))
    }

    /// An element takes a value.
    pub(crate) fn put(self, index: impl Into<Value>, value: impl Into<Value>) -> Statement {
        Statement::Put(self, index.into(), value.into())
    }
}

macro_rules! operators {
    ($($name:ident, $method:ident, $operation:ident);*) => {$(
        impl<T: Into<Value>> $name<T> for Value {
            type Output = Value;
            fn $method(self, other: T) -> Value {
                self.join(Operation::$operation, other)
            }
        }

        impl<T: Into<Value>> $name<T> for Variable {
            type Output = Value;
            fn $method(self, other: T) -> Value {
                Value::Of(self).join(Operation::$operation, other)
            }
        }
    )*};
}

operators! { Add, add, Add; Sub, sub, Subtract; Mul, mul, Multiply; Div, div, Divide }

impl Neg for Value {
    type Output = Value;
    fn neg(self) -> Value {
        Value::Number(-1.0).join(Operation::Multiply, self)
    }
}
