//! The comparison as one JSON object. Keys stand in the order of the alphabet.

use super::{Comparison, Difference};
use crate::results::{Measured, Results};
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use switchback_io::output::{stamped, stamped_schema};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/compare/1";

/// Two reports in units of their Monte-Carlo errors: `compare --json`.
#[derive(Serialize, JsonSchema)]
struct ComparisonFile<'a> {
    /// Whether nothing differs beyond chance.
    agrees: bool,
    /// The first report.
    baseline: Origin<'a>,
    /// Differences beyond chance.
    beyond_chance: Vec<DifferenceFile<'a>>,
    /// Whether every figure is the same.
    identical: bool,
    /// Differences that chance does not explain: of the study, the truth, theory or bound, of what was judged, or made of equal figures.
    known: &'a [String],
    /// Largest difference in standard errors; null where it is infinite, both figures being exact and different.
    #[schemars(with = "Option<f64>", range(min = 0))]
    largest_z: f64,
    /// Figures in both.
    measures: usize,
    /// The second report.
    new: Origin<'a>,
    /// Figures that the second lacks.
    only_baseline: &'a [String],
    /// Figures that the first lacks.
    only_new: &'a [String],
    /// Differences that two runs of one study may have: seed, replicates, what was made of other figures.
    runs: &'a [String],
    /// What chance stays below.
    #[schemars(range(min = 0))]
    threshold: f64,
}

/// What a report is.
#[derive(Serialize, JsonSchema)]
struct Origin<'a> {
    /// The scenario's name.
    name: &'a str,
    /// The seed of every random stream.
    seed: u64,
    /// Switchback's version.
    version: &'a str,
}

/// A figure that differs.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Difference")]
struct DifferenceFile<'a> {
    /// In the first report, with its Monte-Carlo standard error.
    baseline: Measured,
    /// What is measured.
    measure: &'static str,
    /// In the second report, with its Monte-Carlo standard error.
    new: Measured,
    /// Of which parameter.
    parameter: &'a str,
    /// Samples of each experiment.
    samples: usize,
    /// The curve.
    series: String,
    /// The difference in standard errors; null where it is infinite.
    #[schemars(with = "Option<f64>")]
    z: f64,
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<ComparisonFile<'_>>(SCHEMA)
}

/// One JSON object, indented, with a newline at its end.
pub fn json(comparison: &Comparison, baseline: &Results, new: &Results) -> String {
    let page = ComparisonFile {
        agrees: comparison.agrees(),
        baseline: origin(baseline),
        beyond_chance: comparison.beyond_chance().into_iter().map(difference).collect(),
        identical: comparison.identical(),
        known: &comparison.known,
        largest_z: comparison.differences.iter().map(|d| d.z.abs()).fold(0.0, f64::max),
        measures: comparison.differences.len(),
        new: origin(new),
        only_baseline: &comparison.only_baseline,
        only_new: &comparison.only_new,
        runs: &comparison.runs,
        threshold: comparison.threshold,
    };
    stamped(SCHEMA, &page)
}

fn origin(results: &Results) -> Origin<'_> {
    Origin { name: &results.name, seed: results.seed, version: &results.version }
}

fn difference(d: &Difference) -> DifferenceFile<'_> {
    DifferenceFile {
        baseline: d.baseline,
        measure: d.place.measure,
        new: d.new,
        parameter: &d.place.parameter,
        samples: d.place.samples,
        series: d.place.series.to_string(),
        z: d.z,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::compare;
    use crate::results::synthetic;
    use serde_json::Value;

    #[test]
    fn the_object_says_whether_the_two_agree_and_what_differs() {
        let baseline = synthetic::results();
        let page = |new: &Results| -> Value {
            serde_json::from_str(&json(&compare(&baseline, new), &baseline, new)).expect("JSON")
        };
        let same = page(&baseline);
        assert_eq!((&same["agrees"], &same["identical"]), (&Value::Bool(true), &Value::Bool(true)));

        let mut new = baseline.clone();
        let bias = &mut new.cells[0].parameters[0].bias;
        *bias = bias.and_then(|m| Measured::new(m.value() + 30.0 * m.mcse(), m.mcse()));
        let other = page(&new);
        assert_eq!(other["agrees"], false);
        assert_eq!(other["beyond_chance"][0]["measure"], "bias");
        assert_eq!(other["beyond_chance"][0]["parameter"], "a1");
    }
}
