//! The methods by their names on the command line.

use std::fmt::{self, Display};
use std::str::FromStr;
use switchback_estimator::rig::{Rig, Role};

/// A way from records to a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Method {
    /// The paper's least squares on the descendant experiment, (3.21)–(3.25).
    PaperDescendant,
    /// Its mirror image on the ascendant experiment.
    PaperAscendant,
    /// Both experiments at once: a and b shared, a constant column instead of the step experiment.
    Joint,
    /// The rank-one constrained estimate, at the Cramér–Rao bound.
    Efficient,
    /// Any record, no designed experiment.
    Free,
    /// Yardstick: a linear ARX model.
    LinearArx,
    /// Yardstick: a Hammerstein model with one static curve for both directions.
    Memoryless,
}

impl Method {
    /// Every method, in the order of the documentation.
    pub const ALL: [Self; 7] = [
        Self::PaperDescendant,
        Self::PaperAscendant,
        Self::Joint,
        Self::Efficient,
        Self::Free,
        Self::LinearArx,
        Self::Memoryless,
    ];

    /// The name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::PaperDescendant => "paper-descendant",
            Self::PaperAscendant => "paper-ascendant",
            Self::Joint => "joint",
            Self::Efficient => "efficient",
            Self::Free => "free",
            Self::LinearArx => "linear-arx",
            Self::Memoryless => "memoryless",
        }
    }

    /// The best method that the rig's fit records allow: a designed experiment beats a free record, two beat one.
    pub fn default_for(rig: &Rig) -> Self {
        let has = |role| rig.fit_records().any(|record| record.role == role);
        match (has(Role::Descendant), has(Role::Ascendant)) {
            (true, true) => Self::Efficient,
            (true, false) if has(Role::StepHigh) => Self::PaperDescendant,
            (false, true) if has(Role::StepLow) => Self::PaperAscendant,
            _ => Self::Free,
        }
    }
}

impl Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|method| method.name() == name)
            .ok_or_else(|| format!("the methods are {}", Self::ALL.map(Self::name).join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_leads_back_to_its_method() {
        for method in Method::ALL {
            assert_eq!(method.name().parse(), Ok(method));
        }
        assert!("kalman".parse::<Method>().unwrap_err().contains("paper-descendant"));
    }
}
