//! The answer, and what is not decided by the posterior alone.

pub(crate) mod answer;
pub(crate) mod decide;
pub(crate) mod odds;
