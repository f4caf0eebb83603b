//! Rigs of the laboratory: drawn with designed records, diagnosed blind.
//!
//! A diagnosis gets a [`Rig`](switchback_model::rig::Rig) rebuilt from its recipe, which holds what a user's folder holds and nothing else.

mod confounded_effects;
mod judge;
mod key;
mod measure;
mod place;
mod score;
mod statement;
mod tables;

pub(crate) use confounded_effects::same_class;
pub(crate) use judge::judged;
pub(crate) use key::key_line;
pub(crate) use key::sealed;
pub(crate) use measure::targets;
pub(crate) use score::score;
