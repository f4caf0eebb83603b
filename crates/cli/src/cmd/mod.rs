//! One file a verb: its arguments and what it does.

pub mod calibrate;
pub mod compare;
pub mod completions;
pub mod consistency;
pub mod data_args;
pub mod design;
pub mod examination;
pub mod export;
pub mod fmu_host;
pub mod gap;
pub mod identify;
pub mod init;
pub mod launch;
pub mod man;
pub mod merge;
mod partial;
pub mod plant;
pub mod power;
pub mod replay;
pub mod report;
pub mod rig;
pub mod selftest;
pub mod simulate;
pub mod study;
