//! One file a verb: its arguments and what it does.

pub mod blind;
pub mod compare;
pub mod gap;
pub mod identify;
pub mod rig;
pub mod simulate;
pub mod study;
