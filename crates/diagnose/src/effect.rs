//! What the rest of the crate asks of an effect, and the stages of the block diagram that effects sit in.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub use crate::effects::Effect;

/// A stage of the block diagram `v → input → operator → dynamics → (disturbance) → sensor → y`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum Stage {
    /// Between the recorded `v` and the operator.
    Input,
    /// The switched hysteresis itself.
    Operator,
    /// The linear part.
    Dynamics,
    /// What drives the output besides the input.
    Disturbance,
    /// Between the true output and the recorded `y`.
    Sensor,
}

impl Stage {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Operator => "operator",
            Self::Dynamics => "dynamics",
            Self::Disturbance => "disturbance",
            Self::Sensor => "sensor",
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Effect {
    /// The effect of that name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|e| e.name() == name)
    }

    /// Where in the block diagram the effect sits.
    pub fn stage(self) -> Stage {
        self.card().stage
    }

    /// The effects that leave nearly the same trace in ordinary records.
    pub fn confounded_effects(self) -> &'static [Self] {
        self.card().confounded_effects
    }

    /// Whether the effect follows a clock or has a phase of its own in every record, so that what was fitted need not hold
    /// in other records.
    pub(crate) fn is_of_its_record(self) -> bool {
        self.card().of_its_record
    }

    /// Whether the effect changes only what is random, so that it moves no simulation error.
    pub fn is_noise(self) -> bool {
        self.card().noise
    }

    /// Whether a simulation without the effect is as good as one with it: it is noise, or rounds.
    pub(crate) fn moves_no_simulation(self) -> bool {
        self.is_noise() || self.card().rounds
    }
}

/// By its name.
impl Serialize for Effect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Effect {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::from_name(&name).ok_or_else(|| D::Error::custom(format!("`{name}` is no effect")))
    }
}

/// One of the names.
impl JsonSchema for Effect {
    fn schema_name() -> Cow<'static, str> {
        "Effect".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "enum": Self::ALL.map(Self::name) })
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
