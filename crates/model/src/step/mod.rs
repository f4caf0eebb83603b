//! A causal model, sample by sample: one small program that runs here and in C.
//!
//! [`Model`] says what a model is made of, [`Model::program`] writes its laws once, as a [`Program`] on a fixed memory; [`Machine`] runs it,
//! [`c`] writes it in C99. Pure: no files, clocks or threads.

mod check;
mod laws;
mod machine;
mod model;
mod print;
mod program;
mod run;

pub use check::Fault;
pub use laws::NEGLIGIBLE;
pub use machine::{Machine, Memory};
pub use model::{
    Beyond, Borders, Bumps, Column, Cubic, Curve, Direction, Effects, Knee, Linear, Model, Play, Relaxation,
    Scale, Sensor, Transition, TransitionLaw, Widening,
};
pub use print::{Heading, c};
pub use program::{
    Array, ArrayCard, Condition, Function, Lives, Operation, Procedure, ProcedureCard, Program, Statement,
    Value, Variable, VariableCard,
};
pub use run::Run;
