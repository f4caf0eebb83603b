//! The methods a sweep can compare.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use switchback_model::rig::Role;

/// A method from records to a system. The serialised form is the name used in scenario files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// The paper's least squares on the descendant experiment, (3.21)–(3.25).
    PaperDescendant,
    /// Its mirror image on the ascendant experiment.
    PaperAscendant,
    /// Both experiments at once: a and b shared, a constant column instead of the step experiment.
    Joint,
    /// The rank-one constrained estimate, at the Cramér–Rao bound.
    Efficient,
    /// Refined instrumental variables on the means over periods: consistent whatever the colour of the noise.
    Instrumental,
    /// Any record, no designed experiment.
    Free,
    /// Baseline: a linear ARX model.
    LinearArx,
    /// Baseline: a Hammerstein model with one static curve for both directions.
    Memoryless,
}

impl Method {
    /// Every method, in the order of the documentation.
    pub const ALL: [Self; 8] = [
        Self::PaperDescendant,
        Self::PaperAscendant,
        Self::Joint,
        Self::Efficient,
        Self::Instrumental,
        Self::Free,
        Self::LinearArx,
        Self::Memoryless,
    ];

    /// The name used in scenario files, results and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::PaperDescendant => "paper-descendant",
            Self::PaperAscendant => "paper-ascendant",
            Self::Joint => "joint",
            Self::Efficient => "efficient",
            Self::Instrumental => "instrumental",
            Self::Free => "free",
            Self::LinearArx => "linear-arx",
            Self::Memoryless => "memoryless",
        }
    }

    /// The method of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|m| m.name() == name)
    }

    /// Whether the method is fitted to records of this role where they are there; the others are simulated only, or give a mean.
    pub fn is_fitted_to(self, role: Role) -> bool {
        match self {
            Self::PaperDescendant => role == Role::Descendant,
            Self::PaperAscendant => role == Role::Ascendant,
            Self::Joint | Self::Efficient | Self::Instrumental => {
                matches!(role, Role::Descendant | Role::Ascendant)
            }
            Self::Free | Self::LinearArx | Self::Memoryless => true,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_leads_back_to_its_method_and_is_the_serialised_form() {
        for method in Method::ALL {
            assert_eq!(Method::from_name(method.name()), Some(method));
            let json = serde_json::to_string(&method).expect("a method serialises");
            assert_eq!(json, format!("\"{}\"", method.name()));
        }
    }
}
