//! The nominal model: identified from the records, its order chosen and its border knots placed; or given by the user.

pub(crate) mod dynamics;
pub(crate) mod given;
pub(crate) mod identified;
pub(crate) mod identify;
pub(crate) mod knots;
pub(crate) mod order;
pub(crate) mod structure;
