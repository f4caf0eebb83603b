//! The direction in which a pulse experiment visits its levels.

use std::fmt;
use switchback_model::hysteresis::{Branch, Interval};

/// The direction in which a pulse experiment leaves its satellite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// The descendant experiment (3.1): falls from the satellite `h_M`, and so shows `C_d`.
    Descendant,
    /// The ascendant experiment (4.1): rises from the satellite `h_m`, and so shows `C_a`.
    Ascendant,
}

impl Direction {
    /// Where the input sits between visits: `h_M` for the descendant, `h_m` for the ascendant experiment.
    pub fn satellite(self, interval: Interval) -> f64 {
        match self {
            Self::Descendant => interval.high(),
            Self::Ascendant => interval.low(),
        }
    }

    /// The other end of the interval: the first level `V₁`, and where a record loads its border.
    pub fn opposite(self, interval: Interval) -> f64 {
        match self {
            Self::Descendant => interval.low(),
            Self::Ascendant => interval.high(),
        }
    }

    /// The border that the visits show; the returns to the satellite run on the other one.
    pub fn visited_branch(self) -> Branch {
        match self {
            Self::Descendant => Branch::Descending,
            Self::Ascendant => Branch::Ascending,
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Descendant => "descendant",
            Self::Ascendant => "ascendant",
        })
    }
}
