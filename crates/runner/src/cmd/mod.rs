//! One file a verb: its arguments and what it does.

pub mod blind;
pub mod identify;
pub mod rig;
