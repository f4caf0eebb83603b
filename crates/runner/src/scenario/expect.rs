//! What a scenario says must come out.

use super::Method;

/// The outcome a scenario promises; a promise that is not kept ends the run with exit code 1.
///
/// Empty lists promise nothing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Expect {
    /// Methods whose every verdict must be consistent.
    pub consistent: Vec<Method>,
    /// Methods that must be found inconsistent.
    pub inconsistent: Vec<Method>,
    /// Measures of the `consistent` methods that must agree with theory within Monte-Carlo error.
    pub within_error: Vec<Check>,
}

impl Expect {
    /// Whether nothing is promised.
    pub fn is_empty(&self) -> bool {
        self.consistent.is_empty() && self.inconsistent.is_empty() && self.within_error.is_empty()
    }
}

/// A measure that theory predicts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Check {
    /// The standard deviation falls as `N^(−1/2)`.
    SdSlope,
    /// The bias falls as `N⁻¹` where it can be resolved.
    BiasSlope,
    /// Empirical over asymptotic standard deviation is 1 at the largest `N`.
    SdOverTheory,
    /// 95 % intervals cover the truth 95 % of the time at the largest `N`.
    Coverage,
    /// The variance of `efficient` over the Cramér–Rao bound is 1 at the largest `N`.
    Efficiency,
}

impl Check {
    /// Every check, in the order of the report's columns.
    pub const ALL: [Self; 5] =
        [Self::SdSlope, Self::BiasSlope, Self::SdOverTheory, Self::Coverage, Self::Efficiency];

    /// The name used in scenario files.
    pub fn name(self) -> &'static str {
        match self {
            Self::SdSlope => "sd_slope",
            Self::BiasSlope => "bias_slope",
            Self::SdOverTheory => "sd_over_theory",
            Self::Coverage => "coverage",
            Self::Efficiency => "efficiency",
        }
    }

    /// The check of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.name() == name)
    }
}
