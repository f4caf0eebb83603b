//! Which effects explain what the nominal model misses.

pub(crate) mod contest;
pub(crate) mod explain;
pub(crate) mod pairs;
pub(crate) mod search;
pub(crate) mod starts;

/// Penalised deviance that an effect must gain before anything is missing at all: covers the search over twenty effects,
/// their laws and their own parameters.
pub(crate) const SIGNIFICANT: f64 = 40.0;
