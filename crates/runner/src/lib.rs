//! The `switchback` program: scenarios, rig files, Monte-Carlo execution, studies, plots and reports.

pub mod failure;
pub mod input;
pub mod output;
pub mod rig;
