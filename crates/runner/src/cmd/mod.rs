//! One file a verb: its arguments and what it does.

pub mod compare;
pub mod identify;
pub mod study;
