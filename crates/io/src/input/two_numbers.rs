//! `[low, high]`

use serde::{Deserialize, Deserializer, de::Error};

/// Two numbers in a list. The reader of TOML passes over what a list holds beyond a pair of Rust's; here it is an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoNumbers(pub [f64; 2]);

impl TwoNumbers {
    /// The same of a key that may be left out.
    ///
    /// # Errors
    /// Anything but two numbers.
    pub fn optional<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 2]>, D::Error> {
        Self::deserialize(deserializer).map(|Self(two)| Some(two))
    }
}

impl<'de> Deserialize<'de> for TwoNumbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let list = Vec::deserialize(deserializer)?;
        let two = list
            .try_into()
            .map_err(|list: Vec<f64>| D::Error::invalid_length(list.len(), &"two numbers, [low, high]"))?;
        Ok(Self(two))
    }
}
