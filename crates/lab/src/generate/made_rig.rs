//! A rig and its key.

use crate::generate::key::{Key, Truth};
use switchback_model::rig::Rig;

/// A rig and, apart from it, its key.
#[derive(Debug)]
pub struct MadeRig {
    /// What a user's folder would hold.
    pub rig: Rig,
    /// What is withheld.
    pub key: Key,
    /// What is true of each record, in the rig's order.
    pub truth: Vec<Truth>,
}
