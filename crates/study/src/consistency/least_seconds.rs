//! How long a study takes, before it is run.

use super::cost::of_a_replicate;
use super::run_state::Rule;
use crate::scenario::Scenario;

/// Seconds of one thread that a study takes at least. Cells that share their noise cost the pulse methods next to nothing beside it; what a
/// precision adds is known only as far as the error of a standard deviation goes, which depends on the number of replicates alone.
pub fn least_seconds(scenario: &Scenario) -> f64 {
    Rule::of(scenario).forecast() as f64 * of_a_replicate(scenario)
}
