//! Requests and answers as lines of JSON.

use super::design::Design;
use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use switchback_identify::excitation::Direction;
use switchback_io::output::schema;

/// Name and version of the protocol.
pub const PROTOCOL: &str = "switchback/method/1";

/// The first line in either direction of the protocol `switchback/method/1`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Greeting {
    /// `switchback/method/1`.
    #[schemars(extend("const" = PROTOCOL))]
    pub schema: String,
    /// Version of the estimator; of the program in its own greeting.
    #[serde(default)]
    pub version: String,
}

/// A request of the protocol `switchback/method/1`: one replicate of a cell, whose parameters are to be estimated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Request {
    /// To be repeated in the answer.
    pub id: u64,
    /// Number of the replicate.
    pub replicate: u32,
    /// Whether its noise has the other sign.
    pub antithetic: bool,
    /// `y(t)` of each experiment.
    pub y: [Stored; 2],
    /// Place of the cell in the results.
    pub cell: usize,
    /// Order `n` to assume.
    pub order: usize,
    /// Points `m` on each border.
    pub points: usize,
    /// `N`: regression samples of each record.
    pub samples: usize,
    /// Where the input may go.
    pub interval: [f64; 2],
    /// Names of the parameters, in the order of the answer.
    pub parameters: Vec<String>,
    /// The file of little-endian float64 numbers that hold inputs and outputs.
    pub block: String,
    /// Descendant and ascendant experiment.
    pub experiments: [RequestExperiment; 2],
}

/// One pulse experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RequestExperiment {
    /// `descendant` or `ascendant`.
    pub name: String,
    /// `V₁…V_m`, input units.
    pub levels: Vec<f64>,
    /// Where the input rests between visits.
    pub satellite: f64,
    /// Samples before `t = 0`, which serve as lags only.
    pub lead: usize,
    /// `v(t)`.
    pub v: Stored,
}

/// Numbers in the block: from which one on, and how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Stored {
    /// Numbers before the first.
    pub at: usize,
    /// How many.
    pub count: usize,
}

/// An answer of the protocol `switchback/method/1`: estimates, or why there are none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// That of the request.
    pub id: u64,
    /// One number a parameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Vec<Option<f64>>>,
    /// Their standard errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub se: Option<Vec<Option<f64>>>,
    /// Why there is no estimate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
}

/// The JSON Schemas of a greeting, a request and an answer.
pub fn schemas() -> [Schema; 3] {
    [
        schema::<Greeting>("switchback/method-greeting/1"),
        schema::<Request>("switchback/method-request/1"),
        schema::<Answer>("switchback/method-answer/1"),
    ]
}

impl Answer {
    /// The answer that a line holds; `None` where it holds none. What Python writes for numbers that are none is read, too.
    pub(super) fn read(line: &[u8]) -> Option<Self> {
        serde_json::from_slice(line).ok().or_else(|| {
            let text = std::str::from_utf8(line)
                .ok()
                .filter(|text| text.contains("NaN") || text.contains("Infinity"))?;
            let text = text.replace("-Infinity", "null").replace("Infinity", "null").replace("NaN", "null");
            serde_json::from_str(&text).ok()
        })
    }
}

/// All of a request that the replicates of a cell have in common, as it is written: behind `y`, to the end of the line.
pub(super) fn common(design: &Design, block: &str, v: [Stored; 2]) -> String {
    let experiment = |k: usize| {
        let of = &design.experiments[k];
        let name = if of.direction == Direction::Descendant { "descendant" } else { "ascendant" };
        RequestExperiment {
            name: name.to_owned(),
            levels: of.levels.clone(),
            satellite: of.satellite,
            lead: of.lead,
            v: v[k],
        }
    };
    let nothing = Stored { at: 0, count: 0 };
    let request = Request {
        id: 0,
        replicate: 0,
        antithetic: false,
        y: [nothing; 2],
        cell: design.cell,
        order: design.order,
        points: design.points,
        samples: design.samples,
        interval: design.interval,
        parameters: design.parameters.clone(),
        block: block.to_owned(),
        experiments: [0, 1].map(experiment),
    };
    let text = serde_json::to_string(&request).expect("numbers and names are JSON");
    let begin = text.find("\"cell\":").expect("a key of every request");
    text[begin..].to_owned() + "\n"
}

/// The line of a request.
pub(super) fn line(id: u64, replicate: u32, antithetic: bool, y: [Stored; 2], common: &str) -> String {
    let [first, second] = y;
    format!(
        "{{\"id\":{id},\"replicate\":{replicate},\"antithetic\":{antithetic},\"y\":[{{\"at\":{},\"count\":{}}},{{\"at\":{},\"count\":{}}}],{common}",
        first.at, first.count, second.at, second.count
    )
}
