//! One file of a plan: its columns as evenly sampled pieces.

use super::clock_source::ClockSource;
use super::even::{Even, Signals};
use super::names::ColumnNames;
use super::request::Request;
use super::select::Selection;
use super::taken::Series;
use super::{counters, rates, two_part_stamps};
use crate::chosen::{Chosen, LogReader};
use crate::table::{Column, DataError, DataProblem, Place, Table, TableError, unit};
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
    /// What may have been read wrongly, one sentence each.
    pub doubts: Vec<String>,
}

impl Measured {
    /// Reads a file.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn read(path: &Path, request: Request<'_>) -> Result<Self, Vec<TableError>> {
        let one = |error: TableError| vec![error];
        if let Some(read) = Table::log_reader(path).map_err(one)? {
            let (table, names) = Self::logged(read, path, request).map_err(one)?;
            return Self::of(table, Request { names: &names, ..request });
        }
        let table = Table::read(path, if request.needs_output { 2 } else { 1 }).map_err(one)?;
        Self::of(table, request)
    }

    /// The signals of a log that are input and output, or all of its first rows where that is in doubt; with the names given, of which those that
    /// are positions among all signals are names of these then.
    fn logged(
        read: LogReader,
        path: &Path,
        request: Request<'_>,
    ) -> Result<(Table, ColumnNames), TableError> {
        let Request { names, input_form, needs_output, .. } = request;
        let mut found = names.clone();
        let table = read(path, &mut |head| {
            let selection = Selection::of(head, names, input_form, needs_output).ok()?;
            let name = |given: &mut Option<String>, k: Option<usize>| {
                if let (Some(given), Some(k)) = (given, k) {
                    *given = head.columns[k].label();
                }
            };
            name(&mut found.time, selection.time);
            name(&mut found.input, Some(selection.input));
            name(&mut found.output, selection.output);
            let signals = [selection.input, selection.output.unwrap_or(selection.input)];
            let time = selection.time.filter(|_| names.time.is_some());
            let is_guessed = names.input.is_none() || names.output.is_none();
            let rivals = if is_guessed { selection.rivals } else { Vec::new() };
            Some(Chosen { signals, time, rivals })
        })?;
        Ok((table, found))
    }

    /// Takes a table that was read.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn of(mut table: Table, request: Request<'_>) -> Result<Self, Vec<TableError>> {
        let merged = two_part_stamps::join(&mut table);
        table.notes.extend(merged);
        let at = |path: &str, place, problem| {
            TableError::Data(DataError { path: path.to_owned(), place, problem })
        };
        let mut problems: Vec<TableError> = table.faults.iter().cloned().map(TableError::Data).collect();
        let mut selection =
            match Selection::of(&table, request.names, request.input_form, request.needs_output) {
                Ok(selection) => selection,
                Err(found) => {
                    problems.extend(found.into_iter().map(|problem| at(&table.path, None, problem)));
                    return Err(problems);
                }
            };
        selection.time.into_iter().for_each(|time| table.columns[time].exact());
        let faults = Signals { table: &table, selection: &selection, request }.faults();
        problems.extend(
            faults.into_iter().map(|(row, problem)| at(&table.path, Some(table.places.get(row)), problem)),
        );
        if !problems.is_empty() {
            return Err(problems);
        }
        let repaired = counters::repair(&mut table, &selection);
        let joined = rates::join(
            &mut table,
            &mut selection,
            (request.sampling.resample, request.names.time.is_some()),
        );
        table.notes.extend(repaired.into_iter().chain(joined));
        let signals = Signals { table: &table, selection: &selection, request };
        let rows = signals.complete_rows();
        let even = signals.sampled(&rows).map_err(|(sample, problem)| {
            vec![at(&table.path, sample.map(|sample| table.places.get(rows[sample])), problem)]
        })?;
        Ok(Self::with_table(even, table, selection))
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

    /// How many pieces begin because time starts anew.
    pub fn starts_anew(&self) -> usize {
        self.interruptions.iter().filter(|why| matches!(why, DataProblem::StartsAnew(_))).count()
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

    /// The column of a simulator's predictions.
    pub fn prediction(&self) -> Option<&Column> {
        self.selection.prediction.map(|k| &self.table.columns[k])
    }

    /// Even samples with the table they come from.
    fn with_table(even: Even, mut table: Table, selection: Selection) -> Self {
        table.notes.extend(even.notes);
        let Even { sample_time, start, source, series, pieces, interruptions, mut doubts, .. } = even;
        let path = &table.path;
        doubts.extend(selection.doubt.clone());
        let doubts = doubts.into_iter().map(|doubt| format!("{path}: {doubt}")).collect();
        let Series { v, y, predicted, rows } = series;
        Self {
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
            doubts,
        }
    }
}
