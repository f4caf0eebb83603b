//! One file a verb: its arguments and what it does.

pub(crate) mod calibrate;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod consistency;
pub(crate) mod data_args;
pub(crate) mod design;
pub(crate) mod examination;
pub(crate) mod export;
pub(crate) mod fmu_host;
pub(crate) mod gap;
pub(crate) mod identify;
pub(crate) mod init;
pub(crate) mod launch;
pub(crate) mod man;
pub(crate) mod merge;
pub(crate) mod method;
pub(crate) mod method_host;
mod partial;
pub(crate) mod plant;
pub(crate) mod power;
pub(crate) mod replay;
pub(crate) mod report;
pub(crate) mod rig;
pub(crate) mod schemas;
pub(crate) mod selftest;
pub(crate) mod simulate;
pub(crate) mod study;
