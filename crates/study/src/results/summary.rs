//! What a curve over `N` amounts to.

use super::{Group, Measured, Series};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// One group of parameters of one curve, over all `N`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Summary {
    /// The curve.
    pub series: Series,
    /// The parameters.
    pub group: Group,
    /// Slope of log sd against log N, fitted over `slope_samples`; −1/2 as N grows.
    pub sd_slope: Option<Fitted>,
    /// The same slope of the standard deviations that theory gives for these N; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub sd_slope_theory: Option<f64>,
    /// Slope of log |bias| against log N, fitted over those of them where it is resolved; −1 as N grows.
    pub bias_slope: Option<Fitted>,
    /// The same slope of the biases that theory gives for these N; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub bias_slope_theory: Option<f64>,
    /// The `N` where the bias is resolved.
    pub bias_slope_samples: Vec<usize>,
    /// What the bias (root mean square over the group) tends to as `N` grows; 0 for a consistent method.
    pub plateau: Option<Fitted>,
    /// Mean coverage of the 95 % intervals at the largest `N`.
    pub coverage: Option<Measured>,
    /// Empirical sd over that of theory at the largest `N`, root mean square over the group.
    pub sd_over_theory: Option<Measured>,
    /// Variance over the Cramér–Rao bound at the largest `N`, mean over the group; 1 at the bound, more above it.
    pub variance_over_bound: Option<Measured>,
    /// What it all says.
    pub verdict: Verdict,
    /// Why, in a few words.
    pub reason: String,
}

/// An estimate with its 95 % interval, all finite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fitted {
    /// The estimate.
    pub estimate: f64,
    /// Lower and upper end of the 95 % interval.
    pub ci: (f64, f64),
}

impl Fitted {
    /// An estimate with its interval; `None` unless all three are finite.
    pub fn new(estimate: f64, ci: (f64, f64)) -> Option<Self> {
        [estimate, ci.0, ci.1].iter().all(|x| x.is_finite()).then_some(Self { estimate, ci })
    }
}

/// Whether the estimates converge to the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Bias and standard deviation fall as theory says.
    Consistent,
    /// A bias remains as `N` grows.
    Inconsistent,
    /// The sweep does not show.
    Undecided,
}

impl Verdict {
    /// What tables call it.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Consistent => "consistent",
            Self::Inconsistent => "inconsistent",
            Self::Undecided => "undecided",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.label())
    }
}

/// Something the scenario said must come out, and whether it did.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expectation {
    /// What was expected.
    pub what: String,
    /// Whether it came out.
    pub held: bool,
    /// The figures behind it.
    pub detail: String,
}
