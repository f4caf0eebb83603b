//! The next experiment as a file that can be played.

use super::Report;
use std::fmt::Write;
use switchback_diagnose::NextExperiment;

/// Name of the file.
pub const NEXT_EXPERIMENT: &str = "next_experiment.csv";

/// Whether a record would distinguish the rivals: their predictions differ by [`TELLING`] standard errors over all of it.
pub fn separates(next: &NextExperiment) -> bool {
    next.distance.is_finite() && next.distance * (next.v.len() as f64).sqrt() >= TELLING
}

/// Two predictions this many standard errors apart are rarely taken for each other.
const TELLING: f64 = 4.0;

/// The columns `t` (s) and `v` (input units) of the record to take next; none where nothing is left to separate, or
/// nothing would separate it.
pub fn next_experiment(report: &Report) -> Option<String> {
    let next = report.diagnosis.next_experiment.as_ref().filter(|next| separates(next))?;
    let mut csv = String::from("t,v\n");
    for (k, v) in next.v.iter().enumerate() {
        // Twelve digits drop what rounding left of the products, and no meaning.
        let stamp: f64 = format!("{:.11e}", k as f64 * report.rig.sample_time).parse().unwrap_or_default();
        let _ = writeln!(csv, "{stamp},{v}");
    }
    Some(csv)
}
