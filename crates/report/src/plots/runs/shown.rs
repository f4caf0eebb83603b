//! The records of a file of series that are drawn, and how.

use crate::plots::legend::{Entry, Sample};
use crate::plots::style::{AFTER, BEFORE, GREY, PALE, Pen, tint};
use plotters::style::RGBColor;
use switchback_io::model::{Banded, RecordSeries, Series};
use switchback_io::output::csv_cell;

/// Records drawn at most: a page is looked at.
const RECORDS: usize = 4;
/// Key of the measured output.
pub(super) const MEASURED: &str = "measured";

/// A file of series with the records to be drawn.
#[derive(Debug)]
pub(crate) struct Shown<'a> {
    /// The file.
    pub(crate) series: &'a Series,
    /// Label and unit of the input.
    pub(crate) input: &'a str,
    /// Label and unit of the output.
    pub(crate) output: &'a str,
    /// Records to be drawn, where they are there.
    pub(crate) records: Vec<String>,
    /// Standard deviation of the noise in the output, where it is known.
    pub(crate) noise: Option<f64>,
}

impl Shown<'_> {
    /// The records to draw: those named, or else the first.
    pub(super) fn records(&self) -> Vec<&RecordSeries> {
        let all = &self.series.records;
        let named = |record: &&RecordSeries| self.records.iter().any(|name| csv_cell(name) == record.record);
        let chosen: Vec<&RecordSeries> = all.iter().filter(named).take(RECORDS).collect();
        if chosen.is_empty() { all.iter().take(1).collect() } else { chosen }
    }

    /// Records that are not drawn though they were asked for.
    pub(crate) fn left_out(&self) -> usize {
        self.records.len().saturating_sub(RECORDS)
    }

    /// Name, run and colour of every model that has a run of a record.
    pub(super) fn runs<'r>(&'r self, record: &'r RecordSeries) -> Vec<(&'r str, &'r Banded, RGBColor)> {
        let names = &self.series.names;
        // Of two models the later one is the better.
        let colour = |k: usize| if k + 1 == names.len() { AFTER } else { BEFORE };
        let run = |(k, (name, run)): (usize, (&'r String, &'r Option<Banded>))| {
            Some((name.as_str(), run.as_ref()?, colour(k)))
        };
        names.iter().zip(&record.runs).enumerate().filter_map(run).collect()
    }

    /// Entries of the measured output, of the models and of their bands.
    pub(super) fn legend(&self, record: &RecordSeries) -> Vec<Entry> {
        let mut entries = vec![Entry::new(Sample::Line(measured_pen()), MEASURED).hiding(MEASURED)];
        for (name, run, colour) in self.runs(record) {
            entries.push(Entry::line(colour, name).hiding(name));
            if run.band.is_some() {
                entries.push(Entry::patch(band_colour(colour), band_key(name)).hiding(band_key(name)));
            }
        }
        entries
    }
}

/// How the measured output is drawn.
pub(super) fn measured_pen() -> Pen {
    Pen::broad(tint(GREY, PALE))
}

/// Colour of a model's band.
pub(super) fn band_colour(colour: RGBColor) -> RGBColor {
    tint(colour, PALE / 2.0)
}

/// Key of a model's band.
pub(super) fn band_key(name: &str) -> String {
    format!("{name}, 95 % band")
}

/// `Held-out` or `Fitted`.
pub(super) fn usage(record: &RecordSeries) -> &'static str {
    if record.usage == "fit" { "Fitted" } else { "Held-out" }
}

/// An axis over the measured outputs and the runs within their range once more: a run that leaves it further must not flatten all else.
pub(super) fn output_range(measured: &[f64], runs: &[&[f64]]) -> Vec<f64> {
    let [low, high] = extremes(measured);
    let reach = (high - low).max(f64::MIN_POSITIVE);
    let runs = runs.iter().copied().flatten();
    measured.iter().chain(runs).map(|y| y.clamp(low - reach, high + reach)).collect()
}

/// The least and the greatest of some values.
pub(super) fn extremes(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
}
