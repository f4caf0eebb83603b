//! From candidates to calibrated probabilities, and from these to a verdict.

pub(crate) mod agreement;
pub(crate) mod answer;
pub(crate) mod by_fit;
pub(crate) mod decide;
pub mod fitted;
pub(crate) mod odds;
pub(crate) mod simulators;
