//! An effect that was put in.

use super::how::How;
use crate::generate::OBSERVABLE;
use serde::{Deserialize, Serialize};

/// An effect as it was put in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// The effect.
    pub effect: &'static str,
    /// Its law.
    pub law: String,
    /// Whether that is the plain one.
    pub plain: bool,
    /// How it came in.
    pub how: How,
    /// Size asked for.
    pub wanted: f64,
    /// Size reached: what survives identification anew.
    pub size: f64,
    /// What the base's model newly misses, in the field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw: Option<f64>,
}

impl Fault {
    /// Whether the records can show it at all.
    pub(crate) fn is_observable(&self) -> bool {
        self.size >= OBSERVABLE
    }

    /// Whether it reaches a size, as near as sizes are met.
    pub(crate) fn reaches(&self, size: f64) -> bool {
        self.size >= 0.95 * size
    }
}
