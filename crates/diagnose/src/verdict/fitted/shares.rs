//! How common causes are.

use serde::{Deserialize, Serialize};

/// How common causes are: shares of all rigs, summing to one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// One of the effects.
    pub effect: f64,
    /// Nothing is missing.
    pub none: f64,
    /// A cause that the library does not have.
    pub none_of_these: f64,
}
