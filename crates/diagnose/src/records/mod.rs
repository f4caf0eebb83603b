//! The records of a rig, in dimensionless form: what was commanded, how it moved, what repeats.

pub(crate) mod dataset;
pub(crate) mod dimensionless;
pub(crate) mod motion;
pub(crate) mod passes;
pub(crate) mod repeats;
mod scale;
pub(crate) mod signal;
