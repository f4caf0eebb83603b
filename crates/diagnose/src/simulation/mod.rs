//! Free runs of a fitted model: where they begin, and what its noise makes of the output.

pub(crate) mod initial_conditions;
pub(crate) mod noise_response;
pub(crate) mod own_paths;
pub(crate) mod simulate;
