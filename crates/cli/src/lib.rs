//! The `switchback` program: the command line.

pub mod build;
pub mod cli;
pub mod cmd;
pub mod failure;
pub mod interrupt;
pub mod launch;
pub mod options;
pub mod progress;
pub mod schemas;
