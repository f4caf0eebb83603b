//! What was put in: the key of a rig, closed until it is diagnosed.

use super::design::{Kind, Ticket};
use crate::examination;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// How a fault came into a rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum How {
    /// The records were changed as the fault changes them; no model took part.
    Exact,
    /// The difference of two simulations of a model was added to the output.
    Carried,
    /// The maker simulated its machine with the fault.
    Made,
}

impl How {
    /// The name in tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Carried => "carried",
            Self::Made => "made",
        }
    }
}

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
    /// Whether it is the key of a ticket.
    fn belongs_to(&self, ticket: &Ticket, base: &str) -> bool {
        let wanted = ticket.fault.map(|fault| (fault.effect, fault.size, fault.by_maker));
        let found = self.fault.as_ref().map(|f| (f.effect.as_str(), f.wanted, f.how == How::Made));
        let is_same_fault = self.refused.is_some() || wanted == found;
        (self.id, self.kind, self.base.as_str(), self.seed) == (ticket.id, ticket.kind, base, ticket.seed)
            && is_same_fault
    }
}

/// A rig whose key is closed.
#[derive(Debug, Clone)]
pub struct Sealed {
    pub(super) ticket: Ticket,
    pub(super) key: Key,
}

impl examination::Sealed for Sealed {
    fn id(&self) -> usize {
        self.ticket.id
    }

    fn key_line(&self) -> String {
        serde_json::to_string(&self.key).expect("numbers and strings are JSON")
    }
}

/// The keys in a key file that the same program wrote, by the number of the rig: what they show need not be searched for again.
#[derive(Debug, Default)]
pub(super) struct WrittenKeys(HashMap<usize, Key>);

impl WrittenKeys {
    /// Reads a key file; lines that are no keys are none.
    pub(super) fn read(text: &str) -> Self {
        let keys = text.lines().filter_map(|line| serde_json::from_str::<Key>(line).ok());
        Self(keys.map(|key| (key.id, key)).collect())
    }

    /// The key of a ticket on a base of this name.
    pub(super) fn of(&self, ticket: &Ticket, base: &str) -> Option<&Key> {
        self.0.get(&ticket.id).filter(|key| key.belongs_to(ticket, base))
    }
}
