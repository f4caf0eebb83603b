//! Which cells belong on one curve.

use crate::MethodName;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What the cells of one curve over `N` share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Series {
    /// Name of the case.
    pub case: String,
    /// Name of the border.
    pub border: String,
    /// The method.
    pub method: MethodName,
    /// Points `m` on each border.
    pub points: usize,
    /// Standard deviation of the noise, output units.
    #[schemars(range(min = 0))]
    pub noise: f64,
}

impl fmt::Display for Series {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}, {}, {}, m = {}, noise {}",
            self.case, self.border, self.method, self.points, self.noise
        )
    }
}

/// A family of parameters that are judged together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// `a₁…aₙ`.
    A,
    /// `b₁…bₙ`.
    B,
    /// Points of the descending border, `F_desc(V₁)…`.
    Descending,
    /// Points of the ascending border, `F_asc(V₁)…`.
    Ascending,
}

impl Group {
    /// Every group, in the order of tables and figures.
    pub const ALL: [Self; 4] = [Self::A, Self::B, Self::Descending, Self::Ascending];

    /// The name used in files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
            Self::Descending => "descending",
            Self::Ascending => "ascending",
        }
    }

    /// What tables and figures call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
            Self::Descending => "descending border",
            Self::Ascending => "ascending border",
        }
    }
}
