//! From candidates to calibrated probabilities, and from these to a verdict.

pub(crate) mod answer;
pub(crate) mod decide;
pub(crate) mod odds;
pub(crate) mod simulators;
