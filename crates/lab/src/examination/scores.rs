//! All tables of an examination.

use super::calibration::{Claims, Stratum};
use super::confusion::Confusion;
use super::measure::Measure;
use super::reply::ClosureCheck;
use super::table::Table;
use std::collections::BTreeMap;

/// All tables of an examination.
#[derive(Debug, Clone)]
pub struct Scores {
    /// The summary: what must be reached, what was.
    pub measures: Vec<Measure>,
    /// What was put in against what was said.
    pub confusion: Confusion,
    /// Claimed probability against what holds.
    pub claims: Claims,
    /// Laboratory: expected calibration error of the likeliest candidate, `none` and `unexplained` among the candidate.
    pub top_error: Option<f64>,
    /// Field: the claims a stratum at a time.
    pub strata: Vec<Stratum>,
    /// Laboratory: closures of large gaps and of others.
    pub closures: Vec<(bool, ClosureCheck)>,
    /// What each design counts its answers into, by name.
    pub tables: BTreeMap<&'static str, Table>,
}
