//! Rigs made by laws of their own, faults put into measured records, and examinations of the diagnosis on both.

pub mod examination;
pub mod generate;
pub mod learning;
pub mod plant;
pub mod population;
pub mod power;
pub mod selftest;
