//! Comparisons of cells that share their noise.

use super::measured::rounded;
use super::{Cell, Group, Parameter, Series};
use crate::MethodName;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What methods and borders are to each other on the same noise: replicate `r` of every cell of a case sees the same unit noise (common
/// random numbers), so what the noise does to both sides of a comparison cancels.
///
/// A parameter is compared with that of the first method of the sweep that estimates it (same border, `m`, noise and `N`), and with
/// that of the sweep's first border (same method, `m`, noise and `N`). `free` drives the system otherwise and has noise of its own, so it is
/// compared over borders only. Where a precision is asked for, a cell that went on longer than the other keeps the noise they share, section by
/// section, and the errors hold all the same.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pairing {
    /// One entry a case and method, then one a case and border, at the largest `N`.
    pub overall: Vec<Overall>,
    /// One entry a pair of curves.
    pub comparisons: Vec<Comparison>,
}

/// A method or a border over all its parameters, `m` and noise levels (and over all borders, or methods), at the largest `N`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Overall {
    /// Name of the case.
    pub case: String,
    /// What is compared.
    pub subject: Subject,
    /// What with.
    pub over: Vec<String>,
    /// `N`.
    pub samples: usize,
    /// How many parameters of cells stand behind it.
    pub parameters: usize,
    /// Geometric mean of their variance ratios.
    pub variance_ratio: Paired,
    /// The same with control variates, where both sides have them in every parameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Paired")]
    pub variance_ratio_controlled: Option<Paired>,
    /// Geometric mean of the ratios of their mean squared errors.
    pub mse_ratio: Paired,
}

/// What is compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Subject {
    /// A method.
    Method(MethodName),
    /// The border of that name.
    Border(String),
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Method(method) => method.fmt(f),
            Self::Border(name) => f.pad(name),
        }
    }
}

/// One curve over another on the same noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    /// The curve that is judged.
    pub series: Series,
    /// The curve it is compared with: the same but for the method, or the same but for the border.
    pub over: Series,
    /// Groups of parameters, for each `N`.
    pub groups: Vec<PairedGroup>,
    /// The largest `N`.
    pub samples: usize,
    /// Single parameters there.
    pub parameters: Vec<PairedParameter>,
}

/// A group of parameters at one `N`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairedGroup {
    /// `N`.
    pub samples: usize,
    /// The parameters.
    pub group: Group,
    /// Geometric mean of their variance ratios.
    pub variance_ratio: Paired,
    /// The same with control variates, where both sides have them in every parameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Paired")]
    pub variance_ratio_controlled: Option<Paired>,
    /// Geometric mean of the ratios of their mean squared errors.
    pub mse_ratio: Paired,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairedParameter {
    /// `a1`, `b2`, `F_desc(V3)`, `F_asc(V2)`.
    pub name: String,
    /// Variance over variance: below 1 the curve that is judged scatters less.
    pub variance_ratio: Paired,
    /// The same with control variates, where both sides have them in every parameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Paired")]
    pub variance_ratio_controlled: Option<Paired>,
    /// Mean squared error over mean squared error: what decides where a bias stays.
    pub mse_ratio: Paired,
    /// Bias less bias, with control variates where both have them.
    pub bias_difference: Paired,
}

/// A ratio or a difference of two figures on the same noise, with its Monte-Carlo standard error, and that of the same from two independent runs;
/// serialised as `[value, mcse, unpaired_mcse]`.
///
/// Both errors are jackknifed over sections of the replicates: the first leaves the same noise out of both figures at once, the
/// second adds the errors of either figure alone in squares. Stored to a thousandth of the smaller one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "(f64, f64, f64)", into = "(f64, f64, f64)")]
#[schemars(extend("prefixItems" = [{ "type": "number" }, { "type": "number", "minimum": 0 }, { "type": "number", "minimum": 0 }]))]
pub struct Paired {
    value: f64,
    mcse: f64,
    unpaired_mcse: f64,
}

/// Why three numbers are no paired figure.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("[{0}, {1}, {2}] is not a figure with its two errors: all must be finite and no error negative")]
pub struct PairedError(f64, f64, f64);

/// Figures are kept to this share of their error.
const RESOLUTION: f64 = 1e-3;

/// A paired error below this share of the unpaired one is rounding: both sides are the same estimates.
const ROUNDING: f64 = 1e-9;

impl Paired {
    /// A figure and its two errors; `None` unless all are finite and no error is negative.
    pub(crate) fn new(value: f64, mcse: f64, unpaired_mcse: f64) -> Option<Self> {
        let valid =
            value.is_finite() && [mcse, unpaired_mcse].iter().all(|error| error.is_finite() && *error >= 0.0);
        let floor = ROUNDING * unpaired_mcse;
        let mcse = if mcse < floor { 0.0 } else { mcse };
        valid.then(|| Self {
            value: rounded(value, (RESOLUTION * mcse.min(unpaired_mcse)).max(floor)),
            mcse: rounded(mcse, RESOLUTION * mcse),
            unpaired_mcse: rounded(unpaired_mcse, RESOLUTION * unpaired_mcse),
        })
    }

    /// The ratio or difference.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Its standard error on shared noise.
    pub fn mcse(&self) -> f64 {
        self.mcse
    }

    /// The standard error that independent runs of as many replicates would leave.
    pub fn unpaired_mcse(&self) -> f64 {
        self.unpaired_mcse
    }

    /// The interval of a ratio, symmetric in its logarithm: `value·exp(±q·mcse/value)`.
    pub fn interval(&self, quantile: f64) -> (f64, f64) {
        self.around(quantile, self.mcse)
    }

    /// The interval of a ratio that independent runs would leave.
    pub fn unpaired_interval(&self, quantile: f64) -> (f64, f64) {
        self.around(quantile, self.unpaired_mcse)
    }

    fn around(&self, quantile: f64, mcse: f64) -> (f64, f64) {
        let factor = (quantile * mcse / self.value).exp();
        (self.value / factor, self.value * factor)
    }
}

impl TryFrom<(f64, f64, f64)> for Paired {
    type Error = PairedError;

    fn try_from((value, mcse, unpaired): (f64, f64, f64)) -> Result<Self, PairedError> {
        Self::new(value, mcse, unpaired).ok_or(PairedError(value, mcse, unpaired))
    }
}

impl From<Paired> for (f64, f64, f64) {
    fn from(p: Paired) -> Self {
        (p.value, p.mcse, p.unpaired_mcse)
    }
}

impl Comparison {
    /// Whether the two curves differ in their method (and in nothing else).
    pub fn is_of_methods(&self) -> bool {
        self.series.method != self.over.method
    }
}

impl Pairing {
    /// What a parameter of a cell is compared with, and how: over another method, or over another border.
    pub(crate) fn find(
        &self,
        methods: bool,
        cell: &Cell,
        parameter: &Parameter,
    ) -> Option<(&Series, &PairedParameter)> {
        self.comparisons
            .iter()
            .filter(|c| c.samples == cell.samples && c.is_of_methods() == methods && c.series.holds(cell))
            .find_map(|c| Some((&c.over, c.parameters.iter().find(|p| p.name == parameter.name)?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_three_numbers_rounded_to_its_error() {
        let ratio = Paired::new(0.712_345_678, 0.01, 0.1).expect("finite");
        assert_eq!(serde_json::to_string(&ratio).expect("finite"), "[0.71235,0.01,0.1]");
        assert_eq!(serde_json::from_str::<Paired>("[0.71235,0.01,0.1]").expect("it reads back"), ratio);
        assert!(serde_json::from_str::<Paired>("[0.7,-0.01,0.1]").is_err());
        assert!(Paired::new(f64::NAN, 0.1, 0.1).is_none());
    }

    #[test]
    fn the_same_estimates_twice_differ_by_nothing() {
        let same = Paired::new(1.0 + 4e-16, 3e-17, 0.1).expect("finite");
        assert_eq!((same.value(), same.mcse(), same.unpaired_mcse()), (1.0, 0.0, 0.1));
        assert_eq!(Paired::new(3e-19, 1e-20, 1e-4).expect("finite").value(), 0.0);
    }

    #[test]
    fn the_interval_of_a_ratio_is_symmetric_in_its_logarithm() {
        let (low, high) = Paired::new(0.5, 0.1, 0.2).expect("finite").interval(2.0);
        assert!((low * high - 0.25).abs() < 1e-12 && high < 0.75 && low > 0.33);
    }
}
