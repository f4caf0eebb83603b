//! What was put into a base: the key of a rig, closed until it is diagnosed.

use crate::examination::design::Kind;
use crate::examination::how::How;
use crate::examination::ticket::Ticket;
use serde::{Deserialize, Serialize};

/// A fault as it was put in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PutIn {
    /// The effect.
    pub effect: String,
    /// Its law.
    pub law: String,
    /// How it came in.
    pub how: How,
    /// Magnitude, in `unit`.
    pub magnitude: f64,
    /// What magnitude 1 means.
    pub unit: String,
    /// Size asked for.
    pub wanted: f64,
    /// Size reached.
    pub size: f64,
    /// What the base's model newly misses.
    pub raw: f64,
    /// Standard deviation of the equation noise, where the maker put it in.
    pub noise_sd: Option<f64>,
}

/// What is withheld about a rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Key {
    /// Position in the design.
    pub id: usize,
    /// What the rig is for.
    pub kind: Kind,
    /// Name of its base.
    pub base: String,
    /// What else is random about it.
    pub seed: u64,
    /// The fault.
    pub fault: Option<PutIn>,
    /// Why there is no such rig.
    pub refused: Option<String>,
}

impl Key {
    /// The key that a line of a key file holds, if it is that of a ticket on a base of this name.
    pub(super) fn written(line: &str, ticket: &Ticket, base: &str) -> Option<Self> {
        let key: Self = serde_json::from_str(line).ok()?;
        let wanted = ticket.faults.first().map(|fault| (fault.effect, fault.size, fault.by_maker));
        let found = key.fault.as_ref().map(|f| (f.effect.as_str(), f.wanted, f.how == How::Made));
        let is_same_fault = key.refused.is_some() || wanted == found;
        let is_same_rig =
            (key.id, key.kind, key.base.as_str(), key.seed) == (ticket.id, ticket.kind, base, ticket.seed);
        (is_same_rig && is_same_fault).then_some(key)
    }
}
