//! The comparison as one JSON object.

use super::judge::{CellDifferences, Comparison, Judged, Measure, ParameterDifferences, Verdict};
use super::limits::Limits;
use super::versions::Version;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use switchback_io::output::{stamped, stamped_schema};
use switchback_study::results::Group;

/// Name and version of the layout.
const SCHEMA: &str = "switchback/bench/1";

/// Two versions of an estimator on the same noise: `bench --json`.
#[derive(Serialize, JsonSchema)]
struct BenchFile<'a> {
    /// The scenario's name.
    scenario: &'a str,
    /// The seed of every random stream.
    seed: u64,
    /// Replicates of each cell.
    replicates: u32,
    /// The version that is compared with.
    baseline: VersionFile<'a>,
    /// The version that is judged.
    new: VersionFile<'a>,
    /// What matters, and how often there may be a false alarm.
    limits: LimitsFile,
    /// Differences that share the chance of a false alarm.
    family: usize,
    /// The verdict on all differences.
    verdict: Verdict,
    /// One entry a measure.
    measures: Vec<MeasureFile>,
    /// One entry a cell.
    cells: Vec<CellFile<'a>>,
}

/// Who estimates.
#[derive(Serialize, JsonSchema)]
struct VersionFile<'a> {
    /// The method.
    name: &'a str,
    /// What it says its version is.
    version: &'a str,
}

/// Limits of a comparison.
#[derive(Serialize, JsonSchema)]
struct LimitsFile {
    /// A difference of bias that matters, in standard deviations of the baseline.
    bias: f64,
    /// A logarithm of a ratio of standard deviations that matters.
    sd: f64,
    /// A difference of failures that matters, as a share of the replicates.
    failures: f64,
    /// Up to this share of what matters a difference is negligible.
    negligible: f64,
    /// The chance of a false alarm, over all differences together.
    false_alarms: f64,
}

/// The verdict on a measure.
#[derive(Serialize, JsonSchema)]
struct MeasureFile {
    /// `bias`, `standard deviation`, `failures`.
    measure: &'static str,
    /// The verdict on all its differences.
    verdict: Verdict,
    /// Replicates that find what matters, nineteen times in twenty; null where nothing is known.
    replicates_that_find: Option<f64>,
}

/// What the versions are to each other in a cell.
#[derive(Serialize, JsonSchema)]
struct CellFile<'a> {
    /// Name of the case.
    case: &'a str,
    /// Name of the border.
    border: &'a str,
    /// Points `m` on each border.
    points: usize,
    /// Standard deviation of the noise.
    noise: f64,
    /// `N`.
    samples: usize,
    /// Replicates of which both have an estimate.
    pairs: usize,
    /// Replicates of which one has none.
    failures: FailureFile<'a>,
    /// One entry a parameter that both estimate.
    parameters: Vec<ParameterFile<'a>>,
}

/// How often each version gives no estimate.
#[derive(Serialize, JsonSchema)]
struct FailureFile<'a> {
    /// Replicates at which the baseline fails.
    baseline: usize,
    /// Replicates at which the new version fails.
    new: usize,
    /// What the new version said first.
    reason: Option<&'a str>,
    /// New less baseline, as a share of the replicates.
    difference: JudgedFile,
}

/// One parameter.
#[derive(Serialize, JsonSchema)]
struct ParameterFile<'a> {
    /// `a1`, `b2`, `F_desc(V3)`, `F_asc(V2)`.
    name: &'a str,
    /// The family that it belongs to.
    group: Group,
    /// New bias less the baseline's, in standard deviations of the baseline.
    bias: JudgedFile,
    /// Logarithm of the new standard deviation over the baseline's.
    sd: JudgedFile,
}

/// A difference; null where a figure is no number.
#[derive(Serialize, JsonSchema)]
struct JudgedFile {
    /// The difference.
    value: Option<f64>,
    /// Its Monte-Carlo standard error.
    se: Option<f64>,
    /// Beyond it a difference is an alarm, or an improvement.
    limit: Option<f64>,
    /// From here on one is found nineteen times in twenty.
    found_from: Option<f64>,
    /// What it means.
    verdict: Verdict,
}

/// The JSON Schema of [`json`].
pub fn schema() -> Schema {
    stamped_schema::<BenchFile<'_>>(SCHEMA)
}

/// One JSON object, indented, with a newline at its end.
pub fn json(
    comparison: &Comparison,
    (scenario, seed): (&str, u64),
    [baseline, new]: &[Version; 2],
) -> String {
    let Limits { bias, sd, failures, false_alarms } = comparison.limits;
    let measure = |measure: Measure| MeasureFile {
        measure: measure.name(),
        verdict: comparison.verdict_on(measure),
        replicates_that_find: comparison.replicates_that_find(measure),
    };
    let page = BenchFile {
        scenario,
        seed,
        replicates: comparison.replicates,
        baseline: version(baseline),
        new: version(new),
        limits: LimitsFile { bias, sd, failures, negligible: Limits::NEGLIGIBLE, false_alarms },
        family: comparison.family,
        verdict: comparison.verdict(),
        measures: Measure::ALL.map(measure).into(),
        cells: comparison.cells.iter().map(cell).collect(),
    };
    stamped(SCHEMA, &page)
}

fn version(of: &Version) -> VersionFile<'_> {
    VersionFile { name: &of.name, version: &of.version }
}

fn cell(of: &CellDifferences) -> CellFile<'_> {
    let CellDifferences { series, samples, pairs, failures, parameters } = of;
    CellFile {
        case: &series.case,
        border: &series.border,
        points: series.points,
        noise: series.noise,
        samples: *samples,
        pairs: *pairs,
        failures: FailureFile {
            baseline: failures.baseline,
            new: failures.new,
            reason: failures.reason.as_deref(),
            difference: judged(failures.judged),
        },
        parameters: parameters.iter().map(parameter).collect(),
    }
}

fn parameter(of: &ParameterDifferences) -> ParameterFile<'_> {
    ParameterFile { name: &of.name, group: of.group, bias: judged(of.bias), sd: judged(of.sd) }
}

fn judged(of: Judged) -> JudgedFile {
    let number = |x: f64| x.is_finite().then_some(x);
    JudgedFile {
        value: number(of.value),
        se: number(of.se),
        limit: number(of.limit),
        found_from: number(of.found_from),
        verdict: of.verdict,
    }
}
