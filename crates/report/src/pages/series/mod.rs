//! Charts of series.csv, which a diagnosis and an identification have in common: the loop, and outputs over time with their residuals.

mod loops;
mod outputs;
mod thin;

pub(super) use loops::loops;
pub(crate) use outputs::outputs;

use super::chart::Ink;
use switchback_io::model::{RecordSeries, Series};
use switchback_io::output::csv_cell;

/// Records drawn at most: a page is looked at.
const RECORDS: usize = 4;

/// What is drawn of a file of series.
pub(super) struct Drawn<'a> {
    pub(super) series: &'a Series,
    /// Label and unit of the input.
    pub(super) input: &'a str,
    /// Label and unit of the output.
    pub(super) output: &'a str,
    /// Records to be drawn, where they are there.
    pub(super) records: Vec<String>,
    /// Standard deviation of the noise in the output, where it is known.
    pub(super) noise: Option<f64>,
}

impl Drawn<'_> {
    /// The records to draw: those named, or else the first.
    fn records(&self) -> Vec<&RecordSeries> {
        let all = &self.series.records;
        let named = |record: &&RecordSeries| self.records.iter().any(|name| csv_cell(name) == record.record);
        let chosen: Vec<&RecordSeries> = all.iter().filter(named).take(RECORDS).collect();
        if chosen.is_empty() { all.iter().take(1).collect() } else { chosen }
    }

    /// Records that are not drawn though they were asked for.
    fn left_out(&self) -> usize {
        self.records.len().saturating_sub(RECORDS)
    }

    /// The colour of a run: of two models the later one is the better.
    fn ink(&self, run: usize) -> Ink {
        if run + 1 == self.series.names.len() { Ink::Blue } else { Ink::Orange }
    }
}

/// `held out` or `fitted`.
fn usage(record: &RecordSeries) -> &'static str {
    if record.usage == "fit" { "fitted" } else { "held out" }
}
