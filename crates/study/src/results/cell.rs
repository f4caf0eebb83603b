//! One cell of the sweep and what came out of it.

use super::{Group, Measured, Series};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_identify::statistics::CLASSES;

/// What the replicates of one (case, border, method, m, noise, N) gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// The curve this cell is a point of.
    pub series: Series,
    /// `N`: regression samples of each experiment.
    pub samples: usize,
    /// What shows that two cells are the same: a hash of system, design, method and versions. Of studies with methods of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub strong_id: Option<String>,
    /// Replicates run, failed ones included.
    pub replicates: usize,
    /// Whether they are as precise as the scenario asks; absent where it does not ask.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "bool")]
    pub precise: Option<bool>,
    /// Replicates that gave no estimate; never redrawn.
    pub failures: Failures,
    /// How far estimates lie from the truth in half widths of the 95 % interval that each replicate reports, one entry a group.
    pub intervals: Vec<Intervals>,
    /// One entry a parameter the method estimates: a, b, descending, ascending, each by increasing index.
    pub parameters: Vec<Parameter>,
}

/// Replicates that gave no estimate. A replicate is found again from the study's seed and its index.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Failures {
    /// How many.
    pub count: usize,
    /// Their indices, ascending; at most the first hundred.
    pub replicates: Vec<usize>,
    /// What the first of them said.
    pub reason: Option<String>,
    /// What each of those said whose indices are kept; empty where all said the same.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reasons: Vec<String>,
}

/// How many replicates' estimates of the parameters of a group lie how far from the truth, in half widths of the 95 % interval that each
/// reports: up to 0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 3, 5, and more. The truth is in the intervals of the first four classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Intervals {
    /// The parameters.
    pub group: Group,
    /// Estimates less than the truth: up to 0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 3, 5 half widths, and more.
    pub below: [u32; CLASSES],
    /// The same of estimates greater than the truth, or equal to it.
    pub above: [u32; CLASSES],
}

/// The performance of one parameter's estimate over the replicates.
///
/// Measures and their errors as in Morris, White, Crowther (2019), Table 6, doi 10.1002/sim.8086. A measure is
/// `None` where it does not exist: no theory for this method, too few replicates, no finite value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// `a1`, `b2`, `F_desc(V3)`, `F_asc(V2)`.
    pub name: String,
    /// The family it is judged with.
    pub group: Group,
    /// Position on the input axis, input units; borders only.
    pub v: Option<f64>,
    /// The true value, in the normalisation `u_M − u_m = 1`.
    pub truth: f64,
    /// Mean of the estimates.
    pub mean_estimate: Option<f64>,
    /// Mean of the estimates less the truth.
    pub bias: Option<Measured>,
    /// The same with the first- and second-order terms of the error, less their exact means, taken out (control variate).
    pub bias_controlled: Option<Measured>,
    /// Standard deviation of the estimates.
    pub sd: Option<Measured>,
    /// The same with the exactly known variance of the linear term put in place of its sample variance.
    pub sd_controlled: Option<Measured>,
    /// Mean squared error.
    pub mse: Option<Measured>,
    /// Share of the 95 % intervals that hold the truth.
    pub coverage: Option<Measured>,
    /// The same with the coverage of the first-order term, less its expectation, taken out (control variate); absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Measured")]
    pub coverage_controlled: Option<Measured>,
    /// Mean score of the 95 % intervals: the width, and 40 times what the truth lies outside; least for intervals that are narrow and right. Of
    /// methods of others that report standard errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Measured")]
    pub interval_score: Option<Measured>,
    /// Share of the 95 % intervals that hold the mean estimate instead of the truth: whether they are as wide as the estimates scatter, whatever the
    /// bias. Of methods of others that report standard errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Measured")]
    pub coverage_bias_eliminated: Option<Measured>,
    /// Root mean square of the standard errors the method reports.
    pub model_sd: Option<Measured>,
    /// `model_sd / sd − 1`.
    pub model_sd_relative_error: Option<Measured>,
    /// Bias of this method at this `N` by theory, to second order in the noise; absent where it is not worked out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64")]
    pub theory_bias: Option<f64>,
    /// Standard deviation of this method at this `N` by theory: from the information of the very samples, to first order in the noise.
    pub theory_sd: Option<f64>,
    /// The Cramér–Rao bound, as a standard deviation.
    pub bound_sd: Option<f64>,
}

impl Cell {
    /// The parameter of that name.
    pub fn find(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|p| p.name == name)
    }
}

impl Parameter {
    /// The bias with the smaller error: controlled where it exists, else plain.
    pub fn best_bias(&self) -> Option<Measured> {
        self.bias_controlled.or(self.bias)
    }

    /// The standard deviation with the smaller error: controlled where it exists, else plain.
    pub fn best_sd(&self) -> Option<Measured> {
        self.sd_controlled.or(self.sd)
    }
}

impl Series {
    /// Whether a cell lies on this curve.
    pub fn holds(&self, cell: &Cell) -> bool {
        cell.series == *self
    }
}
