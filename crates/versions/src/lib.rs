//! Two versions of an estimator on the same noise: what differs, and whether it is worth an alarm; our own methods as such versions.
//!
//! | file | purpose |
//! |---|---|
//! | `versions` | whom to ask, and what they estimate from the records of a scenario |
//! | `limits` | what is negligible, what matters, and how seldom a false alarm may come |
//! | `difference` | differences of bias, standard deviation and failures, from pairs of replicates |
//! | `judge` | all differences of all cells, with their limits and verdicts |
//! | `json`, `text` | what came out, as an object and in words |
//! | `history` | what came out at each version, a line a version |
//! | `own` | our methods behind the interface of those of others |
//! | `service` | the other end of the protocol: an estimator that answers lines |

mod difference;
mod history;
mod json;
mod judge;
mod limits;
mod own;
mod service;
mod text;
mod versions;

pub use history::{Entry, History, HistoryError, Label, Largest, schema as history_schema};
pub use json::{json, schema};
pub use judge::{
    CellDifferences, Comparison, FailureDifference, Judged, Measure, ParameterDifferences, Verdict,
};
pub use limits::Limits;
pub use own::OwnMethod;
pub use service::answer_requests;
pub use text::words;
pub use versions::{BenchError, Version, Versions};
