//! What a scenario says must come out.

use crate::MethodName;

/// The outcome a scenario promises; a promise that is not kept ends the run with exit code 1.
///
/// Empty lists promise nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Expect {
    /// Methods whose every verdict must be consistent.
    pub consistent: Vec<MethodName>,
    /// Methods that must be found inconsistent.
    pub inconsistent: Vec<MethodName>,
    /// Measures of the `consistent` methods that must agree with theory within Monte-Carlo error.
    pub within_error: Vec<Check>,
    /// How often the intervals must hold the truth, at every `N`.
    pub coverage: Option<Coverage>,
    /// How wide they may be.
    pub width: Option<Width>,
}

/// Bounds on the coverage of 95 % intervals, shares from 0 to 1. They hold for `a`, for `b` and for the points of both borders, each averaged over
/// its parameters, at every `N`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// Of the mean over all curves of the case.
    pub mean: (f64, f64),
    /// The least that any curve may have.
    pub least: f64,
}

/// A bound on the width of intervals.
#[derive(Debug, Clone, PartialEq)]
pub struct Width {
    /// The case whose intervals are the measure.
    pub of: String,
    /// Largest ratio of the widths: the median over all parameters and curves, at every `N`.
    pub at_most: f64,
}

/// A measure that theory predicts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Check {
    /// The standard deviation falls with the slope that theory has over the same `N`, to 0.01 and Monte-Carlo error.
    SdSlope,
    /// The bias falls with the slope that theory has over the same `N`, where it can be resolved, to 0.01 and Monte-Carlo error.
    BiasSlope,
    /// Standard deviation over that of theory is 1 at the largest `N`.
    SdOverTheory,
    /// 95 % intervals cover the truth 95 % of the time at the largest `N`.
    Coverage,
    /// The variance of `efficient` over the Cramér–Rao bound is 1 at the largest `N`.
    Efficiency,
}

impl Check {
    /// Every check, in the order of the report's columns.
    pub(crate) const ALL: [Self; 5] =
        [Self::SdSlope, Self::BiasSlope, Self::SdOverTheory, Self::Coverage, Self::Efficiency];

    /// The name used in scenario files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::SdSlope => "sd_slope",
            Self::BiasSlope => "bias_slope",
            Self::SdOverTheory => "sd_over_theory",
            Self::Coverage => "coverage",
            Self::Efficiency => "efficiency",
        }
    }

    /// The check of that name.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.name() == name)
    }
}
