//! Which effects explain what the nominal model misses.

pub(crate) mod contest;
pub(crate) mod explain;
pub(crate) mod pairs;
pub(crate) mod search;
pub(crate) mod starts;
