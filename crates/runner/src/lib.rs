//! The `switchback` program: scenarios, rig files, Monte-Carlo execution, studies, plots and reports.

pub mod plots;
pub mod results;
pub mod scenario;
