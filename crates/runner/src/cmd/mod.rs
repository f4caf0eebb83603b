//! One file a verb: its arguments and what it does.

pub mod blind;
pub mod compare;
pub mod completions;
pub mod design;
pub mod gap;
pub mod identify;
pub mod man;
pub mod data_args;
pub mod gap;
pub mod identify;
pub mod init;
pub mod rig;
pub mod study;
