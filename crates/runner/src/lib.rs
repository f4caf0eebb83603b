//! The `switchback` program: scenarios, rig files, Monte-Carlo execution, studies, plots and reports.

pub mod blind;
pub mod calibrate;
pub mod cli;
pub mod cmd;
pub mod compare;
pub mod design;
pub mod diagnosis;
pub mod examination;
pub mod failure;
pub mod field;
pub mod identification;
pub mod input;
pub mod interrupt;
pub mod model;
pub mod options;
pub mod output;
pub mod plots;
pub mod power;
pub mod progress;
pub mod report;
pub mod results;
pub mod rig;
pub mod scenario;
pub mod selftest;
pub mod study;
