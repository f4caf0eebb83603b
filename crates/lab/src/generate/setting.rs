//! Where a rig stands.

use schemars::JsonSchema;

/// Where a rig stands, and by that who took its records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum Setting {
    /// Order and interval declared, designed experiments, white equation noise, the records of a plan of experiments.
    #[default]
    Laboratory,
    /// Nothing declared, records of everyday inputs, coloured equation noise; and, drawn from the seed, noise on the recorded input,
    /// borders that switch gradually or are curved, a fast pole besides.
    Field,
}

impl Setting {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Laboratory => "laboratory",
            Self::Field => "field",
        }
    }
}
