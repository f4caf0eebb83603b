//! How common causes are.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How common causes are: shares of all rigs, summing to one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Shares {
    /// One of the effects.
    #[schemars(range(min = 0, max = 1))]
    pub effect: f64,
    /// Nothing is missing.
    #[schemars(range(min = 0, max = 1))]
    pub none: f64,
    /// A cause that the library does not have.
    #[schemars(range(min = 0, max = 1))]
    pub none_of_these: f64,
}
