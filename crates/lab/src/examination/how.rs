//! How a fault came into a rig.

use serde::{Deserialize, Serialize};

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
