//! One file of a plan: its columns as evenly sampled pieces.

use super::clock::Clock;
use super::input_form::InputForm;
use super::names::{ColumnNames, NO_TIME, Sampling};
use super::resample::{self, Resampled};
use super::samples_needed::samples_needed;
use super::sampling::{Fault, Stamps, resolution};
use super::select::Selection;
use super::taken::Series;
use super::{faults, guess};
use crate::table::{Column, DataError, DataProblem, Kind, Place, Table, TableError, unit};
use std::ops::Range;
use std::path::Path;

/// One file's columns, evenly sampled between dropouts.
#[derive(Debug)]
pub struct Measured {
    /// The columns as read, with notes on how.
    pub table: Table,
    /// Which columns were taken.
    pub selection: Selection,
    /// Seconds between samples.
    pub sample_time: f64,
    /// Seconds of the first sample by the time column; 0 without one, and where it holds instants.
    pub start: f64,
    /// Origin of the sample time.
    pub source: ClockSource,
    /// The input.
    pub v: Vec<f64>,
    /// The output, where the table has one.
    pub y: Option<Vec<f64>>,
    /// Another simulator's prediction, where the table has one.
    pub predicted: Option<Vec<f64>>,
    /// Samples between dropouts; together all of them.
    pub pieces: Vec<Range<usize>>,
    /// Row of the table that each sample comes from, or lies after.
    rows: Vec<usize>,
    /// What interrupts the record before each piece but the first.
    interruptions: Vec<DataProblem>,
}

/// Where the sample time comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum ClockSource {
    /// The user, who has no time column.
    Given,
    /// The user; the time column agrees.
    GivenAndTime,
    /// The time column, whose steps differ from it by up to this share.
    Time {
        /// Largest difference of a step, as a share of the sample time.
        jitter: f64,
    },
    /// The rows were interpolated.
    Resampled(Resampled),
}

/// What is asked of a file.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// Names of columns, where the user gave them.
    pub names: &'a ColumnNames,
    /// How rows become samples.
    pub sampling: Sampling,
    /// Who asks.
    pub input_form: &'a InputForm,
    /// Whether there must be an output.
    pub needs_output: bool,
}

impl Measured {
    /// Reads a file.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn read(path: &Path, request: Request<'_>) -> Result<Self, Vec<TableError>> {
        let table =
            Table::read(path, if request.needs_output { 2 } else { 1 }).map_err(|error| vec![error])?;
        Self::of(table, request)
    }

    /// Takes a table that was read.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn of(table: Table, request: Request<'_>) -> Result<Self, Vec<TableError>> {
        let at = |place, problem| TableError::Data(DataError { path: table.path.clone(), place, problem });
        let mut problems: Vec<TableError> = table.faults.iter().cloned().map(TableError::Data).collect();
        let selection = match Selection::of(&table, request.names, request.input_form, request.needs_output) {
            Ok(selection) => selection,
            Err(found) => {
                problems.extend(found.into_iter().map(|problem| at(None, problem)));
                return Err(problems);
            }
        };
        let signals = Signals { table: &table, selection: &selection, request };
        problems.extend(
            signals.faults().into_iter().map(|(row, problem)| at(Some(table.places.get(row)), problem)),
        );
        if !problems.is_empty() {
            return Err(problems);
        }
        let rows = signals.complete_rows();
        let even = signals.sampled(&rows).map_err(|(sample, problem)| {
            vec![at(sample.map(|sample| table.places.get(rows[sample])), problem)]
        })?;
        Ok(even.measured(table, selection))
    }

    /// Where a sample stands in the file.
    pub fn place(&self, sample: usize) -> Place {
        self.table.places.get(self.rows[sample])
    }

    /// Where the record is first interrupted, and by what.
    pub fn first_interruption(&self) -> Option<DataError> {
        let problem = self.interruptions.first()?.clone();
        let row = match problem {
            // A gap in time stands where it ends, an empty cell where it is.
            DataProblem::EmptyCell { .. } => self.rows[self.pieces[1].start - 1] + 1,
            _ => self.rows[self.pieces[1].start],
        };
        Some(DataError { path: self.table.path.clone(), place: Some(self.table.places.get(row)), problem })
    }

    /// The time of every sample as it stands in the file; none without a time column, or where rows were interpolated.
    pub fn times(&self) -> Option<Vec<String>> {
        let column = &self.table.columns[self.selection.time?];
        let is_read = !matches!(self.source, ClockSource::Resampled(_));
        is_read.then(|| self.rows.iter().map(|&row| column.written(row)).collect())
    }

    /// The unit of these times where it is not the second.
    pub fn time_unit(&self) -> Option<String> {
        let unit = self.table.columns[self.selection.time?].unit.clone()?;
        (unit::seconds(&unit) != Some(1.0)).then_some(unit)
    }

    /// The input's column.
    pub fn input(&self) -> &Column {
        &self.table.columns[self.selection.input]
    }

    /// The output's column.
    pub fn output(&self) -> Option<&Column> {
        self.selection.output.map(|k| &self.table.columns[k])
    }
}

/// A table with the parts its columns play.
struct Signals<'a> {
    table: &'a Table,
    selection: &'a Selection,
    request: Request<'a>,
}

/// Even samples, before they are distinguished from the table they come from.
struct Even {
    sample_time: f64,
    start: f64,
    source: ClockSource,
    series: Series,
    pieces: Vec<Range<usize>>,
    interruptions: Vec<DataProblem>,
    notes: Vec<String>,
}

impl Even {
    fn measured(self, mut table: Table, selection: Selection) -> Measured {
        table.notes.extend(self.notes);
        let Self { sample_time, start, source, series, pieces, interruptions, .. } = self;
        let Series { v, y, predicted, rows } = series;
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
        [time, Some(input), output.filter(|_| self.request.needs_output)]
            .into_iter()
            .flatten()
            .map(|k| self.column(k))
    }

    /// Cells that are neither a value nor missing, and missing predictions.
    fn faults(&self) -> Vec<(usize, DataProblem)> {
        let prediction = self.selection.prediction.map(|k| self.column(k));
        let mut problems: Vec<(usize, DataProblem)> =
            self.parts().chain(prediction).flat_map(|column| self.column_faults(column)).collect();
        if let Some(column) = prediction
            && let Some(row) = column.values.iter().position(|value| value.is_nan())
            && column.fault_count == 0
        {
            let remedy = "a prediction must cover every sample: fill the gap, or leave the column y_sim out"
                .to_owned();
            problems.push((row, DataProblem::EmptyCell { column: column.label(), remedy }));
        }
        problems.sort_by_key(|(row, _)| *row);
        problems
    }

    fn column_faults(&self, column: &Column) -> Vec<(usize, DataProblem)> {
        let is_time = self.selection.time.is_some_and(|time| std::ptr::eq(self.column(time), column));
        faults::of(column, is_time.then(|| self.request.input_form.no_times()))
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

    fn sampled(&self, rows: &[usize]) -> Result<Even, Fault> {
        let series = self.series(rows.to_vec());
        match self.selection.time {
            Some(time) => self.clocked(series, self.column(time)),
            None => self.unclocked(series),
        }
    }

    /// Without a time column a row is a sample, and a row without values a dropout.
    fn unclocked(&self, series: Series) -> Result<Even, Fault> {
        let sample_time = self.request.sampling.sample_time.ok_or_else(|| (None, self.no_sample_time()))?;
        let starts: Vec<usize> =
            (1..series.rows.len()).filter(|&k| series.rows[k] > series.rows[k - 1] + 1).collect();
        let interruptions = starts.iter().map(|&k| self.empty_cell(series.rows[k - 1] + 1)).collect();
        let pieces = pieces(&starts, series.rows.len());
        let source = ClockSource::Given;
        Ok(Even { sample_time, start: 0.0, source, series, pieces, interruptions, notes: Vec::new() })
    }

    fn clocked(&self, series: Series, column: &Column) -> Result<Even, Fault> {
        let input_form = self.request.input_form;
        let raw: Vec<f64> = series.rows.iter().map(|&row| column.values[row]).collect();
        let clock = Clock::of(column, &raw, input_form).map_err(|problem| (None, problem))?;
        let t: Vec<f64> = raw.iter().map(|stamp| clock.seconds(*stamp)).collect();
        let resolution: Vec<f64> = raw.iter().map(|stamp| resolution(*stamp, clock.unit)).collect();
        let label = column.label();
        let rows = series.rows.clone();
        let written = |k: usize| column.written(rows[k]);
        let stamps = Stamps { column: &label, t: &t, resolution: &resolution, written: &written, input_form };
        let declared = self.request.sampling.sample_time;
        let start = if column.kind == Kind::Stamp { 0.0 } else { t.first().copied().unwrap_or(0.0) };
        if self.request.sampling.resample {
            let even = self.resampled(series, &stamps, declared)?;
            let notes = clock.notes(&raw, even.sample_time, input_form);
            return Ok(Even { start, notes, ..even });
        }
        let timing = stamps.judge(declared)?;
        if timing.sample_time.is_nan() {
            return Err((None, DataProblem::TooShort { found: t.len(), needed: samples_needed(None) }));
        }
        let source = match declared {
            Some(_) => ClockSource::GivenAndTime,
            None => ClockSource::Time { jitter: timing.jitter },
        };
        let reported = |&k: &usize| match series.rows[k] - series.rows[k - 1] {
            1 => stamps.gap(k, timing.sample_time),
            _ => self.empty_cell(series.rows[k - 1] + 1),
        };
        let interruptions = timing.dropouts.iter().map(reported).collect();
        let pieces = pieces(&timing.dropouts, series.rows.len());
        let notes = clock.notes(&raw, timing.sample_time, input_form);
        Ok(Even { sample_time: timing.sample_time, start, source, series, pieces, interruptions, notes })
    }

    fn resampled(&self, series: Series, stamps: &Stamps<'_>, declared: Option<f64>) -> Result<Even, Fault> {
        stamps.check_order()?;
        let too_short = DataProblem::TooShort { found: series.v.len(), needed: samples_needed(None) };
        let step = declared.or_else(|| stamps.mean_step()).ok_or((None, too_short))?;
        let (even, pieces, reported) = resample::resample(&series, stamps.t, step);
        let interruptions =
            pieces.iter().skip(1).map(|piece| self.empty_cell(even.rows[piece.start])).collect();
        Ok(Even {
            sample_time: step,
            start: 0.0,
            source: ClockSource::Resampled(reported),
            series: even,
            pieces,
            interruptions,
            notes: Vec::new(),
        })
    }

    fn no_sample_time(&self) -> DataProblem {
        let Request { names, input_form, .. } = self.request;
        let is_left_out = names.time.as_deref().is_some_and(|name| name.eq_ignore_ascii_case(NO_TIME));
        let unread = || self.table.columns.iter().find_map(guess::unread_time);
        if let (false, Some((column, cell))) = (is_left_out, unread()) {
            let reason = format!("the times of `{column}`, as `{cell}`, cannot be read");
            return DataProblem::NoSampleTime { reason, remedy: input_form.no_times() };
        }
        let reason = match self.selection.index {
            _ if is_left_out => "the time column is left out, as asked for".to_owned(),
            Some(index) => format!(
                "the column `{}` only counts the samples, and there is no time column",
                self.column(index).label()
            ),
            None => format!("there is no time column among {}", self.table.listing()),
        };
        DataProblem::NoSampleTime { reason, remedy: input_form.sample_time_wanted() }
    }

    fn empty_cell(&self, row: usize) -> DataProblem {
        let empty = self.parts().find(|part| part.values[row.min(part.values.len() - 1)].is_nan());
        let column = empty.map_or_else(|| self.column(self.selection.input).label(), Column::label);
        DataProblem::EmptyCell { column, remedy: self.request.input_form.whole() }
    }
}

/// The ranges between the starts given.
fn pieces(starts: &[usize], len: usize) -> Vec<Range<usize>> {
    let begins = std::iter::once(0).chain(starts.iter().copied());
    let ends = starts.iter().copied().chain([len]);
    begins.zip(ends).map(|(begin, end)| begin..end).filter(|piece| !piece.is_empty()).collect()
}
