//! One file of a plan: its columns as evenly sampled pieces.

use super::plan::{ColumnNames, Sampling, Voice};
use super::problem::RigProblem;
use super::resample::{self, Resampled};
use super::sampling::{Fault, Stamps, resolution};
use super::select::Selection;
use crate::input::{Column, DataError, DataProblem, Kind, Place, Table, unit};
use std::ops::Range;
use std::path::Path;

/// One file's columns, evenly sampled between dropouts.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) table: Table,
    pub(super) selection: Selection,
    pub(super) sample_time: f64,
    /// Seconds of the first sample by the time column; 0 without one, and where it holds instants.
    pub(super) start: f64,
    pub(super) source: ClockSource,
    pub(super) v: Vec<f64>,
    pub(super) y: Option<Vec<f64>>,
    pub(super) predicted: Option<Vec<f64>>,
    /// Samples between dropouts; together all of them.
    pub(super) pieces: Vec<Range<usize>>,
    /// Row of the table that each sample comes from, or lies after.
    rows: Vec<usize>,
    /// What interrupts the record before each piece but the first.
    interruptions: Vec<DataProblem>,
}

/// Where the sample time comes from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ClockSource {
    /// The user, who has no time column.
    Given,
    /// The user; the time column agrees.
    GivenAndTime,
    /// The time column, whose steps differ from it by up to this share.
    Time { jitter: f64 },
    /// The rows were interpolated.
    Resampled(Resampled),
}

/// What is asked of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Request<'a> {
    pub(super) names: &'a ColumnNames,
    pub(super) sampling: Sampling,
    pub(super) voice: &'a Voice,
    pub(super) needs_output: bool,
}

impl Measured {
    /// Reads a file.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub(super) fn read(path: &Path, request: Request<'_>) -> Result<Self, Vec<RigProblem>> {
        let table = Table::read(path).map_err(|error| vec![error.into()])?;
        let at = |place, problem| RigProblem::Data(DataError { path: table.path.clone(), place, problem });
        let mut problems: Vec<RigProblem> = table.faults.iter().cloned().map(RigProblem::Data).collect();
        let selection = match Selection::of(&table, request.names, request.voice, request.needs_output) {
            Ok(selection) => selection,
            Err(found) => {
                problems.extend(found.into_iter().map(|problem| at(None, problem)));
                return Err(problems);
            }
        };
        let signals = Signals { table: &table, selection: &selection };
        problems
            .extend(signals.faults().into_iter().map(|(row, problem)| at(Some(table.places[row]), problem)));
        if !problems.is_empty() {
            return Err(problems);
        }
        let rows = signals.complete_rows();
        let even = signals.sampled(&rows, request).map_err(|(sample, problem)| {
            vec![at(sample.map(|sample| table.places[rows[sample]]), problem)]
        })?;
        Ok(even.measured(table, selection))
    }

    /// Where a sample stands in the file.
    pub(super) fn place(&self, sample: usize) -> Place {
        self.table.places[self.rows[sample]]
    }

    /// Where the record is first interrupted, and by what.
    pub(super) fn first_interruption(&self) -> Option<DataError> {
        let problem = self.interruptions.first()?.clone();
        let row = match problem {
            // A gap in time stands where it ends, an empty cell where it is.
            DataProblem::EmptyCell { .. } => self.rows[self.pieces[1].start - 1] + 1,
            _ => self.rows[self.pieces[1].start],
        };
        Some(DataError { path: self.table.path.clone(), place: Some(self.table.places[row]), problem })
    }

    pub(super) fn input(&self) -> &Column {
        &self.table.columns[self.selection.input]
    }

    pub(super) fn output(&self) -> Option<&Column> {
        self.selection.output.map(|k| &self.table.columns[k])
    }
}

/// A table with the parts its columns play.
struct Signals<'a> {
    table: &'a Table,
    selection: &'a Selection,
}

/// Even samples, before they are told apart from the table they come from.
struct Even {
    sample_time: f64,
    start: f64,
    source: ClockSource,
    series: Series,
    pieces: Vec<Range<usize>>,
    interruptions: Vec<DataProblem>,
}

/// The columns taken, and the rows they come from.
pub(super) struct Series {
    pub(super) v: Vec<f64>,
    pub(super) y: Option<Vec<f64>>,
    pub(super) predicted: Option<Vec<f64>>,
    pub(super) rows: Vec<usize>,
}

impl Even {
    fn measured(self, table: Table, selection: Selection) -> Measured {
        let Series { v, y, predicted, rows } = self.series;
        let Self { sample_time, start, source, pieces, interruptions, .. } = self;
        Measured {
            table,
            selection,
            sample_time,
            start,
            source,
            v,
            y,
            predicted,
            pieces,
            rows,
            interruptions,
        }
    }
}

impl Signals<'_> {
    fn column(&self, k: usize) -> &Column {
        &self.table.columns[k]
    }

    /// The columns that must have a value for a row to be a sample.
    fn parts(&self) -> impl Iterator<Item = &Column> {
        let Selection { time, input, output, .. } = *self.selection;
        [time, Some(input), output].into_iter().flatten().map(|k| self.column(k))
    }

    /// Cells that are neither a value nor missing, and missing predictions.
    fn faults(&self) -> Vec<(usize, DataProblem)> {
        let prediction = self.selection.prediction.map(|k| self.column(k));
        let mut problems: Vec<(usize, DataProblem)> =
            self.parts().chain(prediction).flat_map(column_faults).collect();
        if let Some(column) = prediction
            && let Some(row) = column.values.iter().position(|value| value.is_nan())
            && column.fault_count == 0
        {
            problems.push((row, DataProblem::EmptyCell { column: column.label(), is_prediction: true }));
        }
        problems.sort_by_key(|(row, _)| *row);
        problems
    }

    fn complete_rows(&self) -> Vec<usize> {
        let parts: Vec<&Column> = self.parts().collect();
        (0..self.table.places.len())
            .filter(|&row| parts.iter().all(|part| part.values[row].is_finite()))
            .collect()
    }

    fn series(&self, rows: Vec<usize>) -> Series {
        let of = |k: usize| rows.iter().map(|&row| self.column(k).values[row]).collect();
        Series {
            v: of(self.selection.input),
            y: self.selection.output.map(of),
            predicted: self.selection.prediction.map(of),
            rows: rows.clone(),
        }
    }

    fn sampled(&self, rows: &[usize], request: Request<'_>) -> Result<Even, Fault> {
        let series = self.series(rows.to_vec());
        match self.selection.time {
            Some(time) => self.clocked(series, self.column(time), request),
            None => self.unclocked(series, request),
        }
    }

    /// Without a time column a row is a sample, and a row without values a dropout.
    fn unclocked(&self, series: Series, request: Request<'_>) -> Result<Even, Fault> {
        let sample_time =
            request.sampling.sample_time.ok_or_else(|| (None, self.no_sample_time(request.voice)))?;
        let starts: Vec<usize> =
            (1..series.rows.len()).filter(|&k| series.rows[k] > series.rows[k - 1] + 1).collect();
        let interruptions = starts.iter().map(|&k| self.empty_cell(series.rows[k - 1] + 1)).collect();
        let pieces = pieces(&starts, series.rows.len());
        Ok(Even { sample_time, start: 0.0, source: ClockSource::Given, series, pieces, interruptions })
    }

    fn clocked(&self, series: Series, column: &Column, request: Request<'_>) -> Result<Even, Fault> {
        let unit = self.seconds(column).map_err(|problem| (None, problem))?;
        let raw: Vec<f64> = series.rows.iter().map(|&row| column.values[row]).collect();
        let t: Vec<f64> = raw.iter().map(|stamp| unit * stamp).collect();
        let resolution: Vec<f64> = raw.iter().map(|stamp| resolution(*stamp, unit)).collect();
        let label = column.label();
        let stamps = Stamps { column: &label, t: &t, resolution: &resolution };
        let declared = request.sampling.sample_time;
        let start = if column.kind == Kind::Stamp { 0.0 } else { t.first().copied().unwrap_or(0.0) };
        if request.sampling.resample {
            let even = self.resampled(series, &stamps, declared)?;
            return Ok(Even { start, ..even });
        }
        let timing = stamps.judge(declared)?;
        if timing.sample_time.is_nan() {
            return Err((
                None,
                DataProblem::TooShort { found: t.len(), needed: super::assemble::samples_needed(None) },
            ));
        }
        let source = match declared {
            Some(_) => ClockSource::GivenAndTime,
            None => ClockSource::Time { jitter: timing.jitter },
        };
        let told = |&k: &usize| match series.rows[k] - series.rows[k - 1] {
            1 => stamps.gap(k, timing.sample_time),
            _ => self.empty_cell(series.rows[k - 1] + 1),
        };
        let interruptions = timing.dropouts.iter().map(told).collect();
        let pieces = pieces(&timing.dropouts, series.rows.len());
        Ok(Even { sample_time: timing.sample_time, start, source, series, pieces, interruptions })
    }

    fn resampled(&self, series: Series, stamps: &Stamps<'_>, declared: Option<f64>) -> Result<Even, Fault> {
        stamps.check_order()?;
        let too_short =
            DataProblem::TooShort { found: series.v.len(), needed: super::assemble::samples_needed(None) };
        let step = declared.or_else(|| stamps.mean_step()).ok_or((None, too_short))?;
        let (even, pieces, told) = resample::resample(&series, stamps.t, step);
        let interruptions =
            pieces.iter().skip(1).map(|piece| self.empty_cell(even.rows[piece.start])).collect();
        Ok(Even {
            sample_time: step,
            start: 0.0,
            source: ClockSource::Resampled(told),
            series: even,
            pieces,
            interruptions,
        })
    }

    /// Seconds in the unit of the time column; seconds where it names none.
    fn seconds(&self, column: &Column) -> Result<f64, DataProblem> {
        match &column.unit {
            _ if column.kind == Kind::Stamp => Ok(1.0),
            None => Ok(1.0),
            Some(unit) => unit::seconds(unit).ok_or_else(|| DataProblem::NoSampleTime {
                reason: format!("`{unit}`, the unit of `{}`, is no time", column.label()),
                remedy: "write s, ms, us, min or h, or name another column with `--time`; `--time none --rate HZ` goes without one".to_owned(),
            }),
        }
    }

    fn no_sample_time(&self, voice: &Voice) -> DataProblem {
        let reason = match self.selection.index {
            Some(index) => format!(
                "the column `{}` only counts the samples, and there is no time column",
                self.column(index).label()
            ),
            None => format!("there is no time column among {}", self.table.listing()),
        };
        let remedy = match voice {
            Voice::Manifest => {
                "write `sample_time = SECONDS`, or name the time column in `columns`".to_owned()
            }
            Voice::CommandLine(command) => format!(
                "give it in seconds, `{command} --sample-time 0.01`, or as a rate in hertz, `{command} --rate 100`"
            ),
        };
        DataProblem::NoSampleTime { reason, remedy }
    }

    fn empty_cell(&self, row: usize) -> DataProblem {
        let empty = self.parts().find(|part| part.values[row.min(part.values.len() - 1)].is_nan());
        let column = empty.map_or_else(|| self.column(self.selection.input).label(), Column::label);
        DataProblem::EmptyCell { column, is_prediction: false }
    }
}

fn column_faults(column: &Column) -> Vec<(usize, DataProblem)> {
    let named = || column.label();
    let mut problems: Vec<(usize, DataProblem)> = column
        .faults
        .iter()
        .map(|fault| {
            let cell = fault.cell.clone();
            let problem = match column.kind {
                Kind::Stamp => DataProblem::NotAStamp { column: named(), cell },
                _ if cell.parse::<f64>().is_ok() => DataProblem::NotFinite { column: named(), cell },
                _ => DataProblem::NotANumber { column: named(), cell },
            };
            (fault.row, problem)
        })
        .collect();
    let count = column.fault_count - column.faults.len();
    if let (Some((row, _)), true) = (problems.last(), count > 0) {
        problems.push((*row, DataProblem::More { column: named(), count }));
    }
    problems
}

/// The ranges between the starts given.
fn pieces(starts: &[usize], len: usize) -> Vec<Range<usize>> {
    let begins = std::iter::once(0).chain(starts.iter().copied());
    let ends = starts.iter().copied().chain([len]);
    begins.zip(ends).map(|(begin, end)| begin..end).filter(|piece| !piece.is_empty()).collect()
}
