//! The result table: everything a study found, with its Monte-Carlo errors.
//!
//! Plots, reports and comparisons know these types only, so they can be redrawn without simulating again. The bytes
//! of `results.json` depend on the values alone; numbers that are not finite cannot occur in it.

mod cell;
pub mod condensed;
mod csv;
mod curve;
mod json;
mod measured;
mod paired;
mod pooled;
mod series;
mod summary;
#[cfg(any(test, feature = "synthetic"))]
pub mod synthetic;

pub use cell::Cell;
pub(crate) use cell::Failures;
pub(crate) use cell::Intervals;
pub use cell::Parameter;
pub use csv::to_csv;
pub use curve::BorderCurve;
pub use curve::CurvePoint;
pub use json::COMPRESSED;
pub use json::ResultsError;
pub use json::parse;
pub use json::read;
pub use json::schema;
pub use json::to_json;
pub use measured::Measured;
pub use measured::MeasuredError;
pub use paired::Comparison;
pub use paired::Overall;
pub use paired::Paired;
pub use paired::PairedError;
pub use paired::PairedGroup;
pub use paired::PairedParameter;
pub use paired::Pairing;
pub use paired::Subject;
pub use pooled::root_mean_square;
pub use pooled::root_mean_square_exact;
pub use series::Group;
pub use series::Series;
pub(crate) use summary::Expectation;
pub use summary::Fitted;
pub use summary::Summary;
pub use summary::Verdict;

use crate::scenario::{Coupling, Engine, Labels, Scenario, ScenarioError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Version of the layout of `results.json`; a reader refuses any other.
pub(crate) const SCHEMA: u32 = 1;

/// What a consistency study found: `results.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Results {
    /// Version of this layout.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: u32,
    /// Always `consistency`.
    #[schemars(extend("const" = "consistency"))]
    pub study: String,
    /// The scenario's name.
    pub name: String,
    /// What the study was to answer.
    pub question: String,
    /// The seed of every random stream.
    pub seed: u64,
    /// Switchback's version.
    pub version: String,
    /// The command that makes this file again.
    pub command: String,
    /// How far a study came that was stopped; only of such a one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Partial")]
    pub partial: Option<Partial>,
    /// Significant digits that the figures of cells are rounded to in a [condensed] table; `None` where none is rounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "u32")]
    pub digits: Option<u32>,
    /// How the replicates were computed.
    pub engine: Engine,
    /// Whether the cells of a case share their noise (all pulse methods' do; those of `free` share another).
    pub coupling: Coupling,
    /// The numbers of samples that slopes are fitted over.
    pub slope_samples: Vec<usize>,
    /// What the axes are called: quantity and unit of input and output.
    pub labels: Labels,
    /// The scenario file as JSON.
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    pub scenario: serde_json::Value,
    /// The true borders, in the normalisation `u_M − u_m = 1`, one entry a case and border.
    pub curves: Vec<BorderCurve>,
    /// What must come out, and whether it did.
    pub expectations: Vec<Expectation>,
    /// One entry a curve and parameter group.
    pub summaries: Vec<Summary>,
    /// Methods and borders against each other on the same noise; null where every cell has its own.
    pub paired: Option<Pairing>,
    /// One entry a cell: case × border × method × m × noise × N.
    pub cells: Vec<Cell>,
}

/// Not all of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Partial {
    /// Replicates that were run.
    pub replicates: usize,
    /// … of so many, as far as was known.
    pub of: usize,
}

impl fmt::Display for Partial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PARTIAL: the study was stopped after {} of {} replicates.", self.replicates, self.of)
    }
}

impl Results {
    /// The scenario again. It is called by the name of the results, as in `leafspring.toml`.
    ///
    /// # Errors
    /// [`ScenarioError`] if the results hold none that this version can read.
    pub fn to_scenario(&self) -> Result<Scenario, ScenarioError> {
        let text = toml::to_string(&self.scenario).unwrap_or_default();
        Ok(Scenario::parse(&format!("{}.toml", self.name), &text)?.on(self.engine))
    }

    /// What readers of a [condensed] table must know; `None` where nothing is rounded.
    pub fn rounding(&self) -> Option<String> {
        let reported = |digits| {
            format!(
                "ROUNDED: figures have {digits} significant digits, and comparisons of single parameters are left out. `{}` gives all of them.",
                self.command
            )
        };
        self.digits.map(reported)
    }

    /// Whether everything the scenario expects came out.
    pub fn as_expected(&self) -> bool {
        self.expectations.iter().all(|e| e.held)
    }

    /// The curves of the study in the order of the cells, each once.
    pub fn series(&self) -> Vec<&Series> {
        let mut found: Vec<&Series> = Vec::new();
        for cell in &self.cells {
            if !found.contains(&&cell.series) {
                found.push(&cell.series);
            }
        }
        found
    }
}
