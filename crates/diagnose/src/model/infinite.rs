//! Numbers that may be infinite, in formats that know finite ones only: ±∞ as the words `inf` and `-inf`.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number as it is written: JSON has no infinite ones.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub(crate) enum Either {
    Finite(f64),
    Infinite(Infinity),
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub(crate) enum Infinity {
    #[serde(rename = "inf")]
    Positive,
    #[serde(rename = "-inf")]
    Negative,
}

pub(crate) fn serialize<S: Serializer>(x: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    let either = match *x {
        f64::INFINITY => Either::Infinite(Infinity::Positive),
        f64::NEG_INFINITY => Either::Infinite(Infinity::Negative),
        finite => Either::Finite(finite),
    };
    either.serialize(serializer)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(match Either::deserialize(deserializer)? {
        Either::Finite(x) => x,
        Either::Infinite(Infinity::Positive) => f64::INFINITY,
        Either::Infinite(Infinity::Negative) => f64::NEG_INFINITY,
    })
}
