//! Rows of a table as even samples.

use super::clock::Clock;
use super::clock_source::ClockSource;
use super::counter::Counter;
use super::instants::{Instants, Written};
use super::names::{Between, NO_TIME};
use super::pace::Pace;
use super::request::Request;
use super::sampling::{APART, Fault, JITTER, Stamps, nice, resolution};
use super::select::Selection;
use super::taken::Series;
use super::{faults, guess, resample};
use crate::table::{Column, DataProblem, Kind, Place, Table};
use std::ops::Range;
use switchback_model::rig::samples_needed;

/// A table with the parts its columns play.
pub(super) struct Signals<'a> {
    pub(super) table: &'a Table,
    pub(super) selection: &'a Selection,
    pub(super) request: Request<'a>,
}

/// Even samples, before they are distinguished from the table they come from.
pub(super) struct Even {
    pub(super) sample_time: f64,
    pub(super) start: f64,
    pub(super) source: ClockSource,
    pub(super) series: Series,
    pub(super) pieces: Vec<Range<usize>>,
    pub(super) interruptions: Vec<DataProblem>,
    pub(super) notes: Vec<String>,
    pub(super) doubts: Vec<String>,
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
    pub(super) fn faults(&self) -> Vec<(usize, DataProblem)> {
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

    pub(super) fn complete_rows(&self) -> Vec<usize> {
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

    pub(super) fn sampled(&self, rows: &[usize]) -> Result<Even, Fault> {
        match self.selection.time {
            Some(time) => self.clocked(rows, self.column(time)),
            None => self.unclocked(self.series(rows.to_vec())),
        }
    }

    /// Without a time column a row is a sample; a row without values, a count left out and a new header are dropouts.
    fn unclocked(&self, series: Series) -> Result<Even, Fault> {
        let given = self.request.sampling.sample_time;
        let sample_time = given.or(self.table.increment).ok_or_else(|| (None, self.no_sample_time()))?;
        let source = if given.is_some() { ClockSource::Given } else { ClockSource::Stated };
        let rows = &series.rows;
        let counted = self.counter(rows).map(|counter| counter.interruptions()).unwrap_or_default();
        let is_start = |k: &usize| {
            let has_header = |row: &usize| (rows[k - 1] + 1..=rows[*k]).contains(row);
            rows[*k] > rows[k - 1] + 1
                || counted.binary_search(k).is_ok()
                || self.table.breaks.iter().any(has_header)
        };
        let starts: Vec<usize> = (1..rows.len()).filter(is_start).collect();
        let interruptions = starts
            .iter()
            .map(|&k| match rows[k] - rows[k - 1] {
                1 => DataProblem::Interrupted { remedy: self.request.input_form.whole() },
                _ => self.empty_cell(rows[k - 1] + 1),
            })
            .collect();
        let pieces = pieces(&starts, rows.len());
        let (notes, doubts) = (Vec::new(), Vec::new());
        Ok(Even { sample_time, start: 0.0, source, series, pieces, interruptions, notes, doubts })
    }

    /// What counts these rows, where a column does.
    fn counter(&self, rows: &[usize]) -> Option<Counter> {
        let column = self.column(self.selection.index?);
        Counter::of(&rows.iter().map(|&row| column.values[row]).collect::<Vec<_>>())
    }

    fn clocked(&self, rows: &[usize], column: &Column) -> Result<Even, Fault> {
        let input_form = self.request.input_form;
        let raw: Vec<f64> = rows.iter().map(|&row| column.values[row]).collect();
        let declared = self.request.sampling.sample_time;
        let clock = Clock::of(column, &raw, input_form).map_err(|problem| (None, problem))?;
        let clock = match declared {
            _ if self.is_own_form(column) => clock.settled(),
            Some(_) => clock.counting(&raw, declared).settled(),
            None => clock.paced(&raw, || Pace::of(self.table, rows, &raw)).counting(&raw, None),
        };
        let seconds: Vec<f64> = raw.iter().map(|stamp| clock.seconds(*stamp)).collect();
        let instants = self.instants(rows, (column, &seconds))?;
        let rows: Vec<usize> = instants.kept.iter().map(|&k| rows[k]).collect();
        let resolution: Vec<f64> = match column.kind == Kind::Number && column.origin != 0 {
            true => vec![clock.unit; rows.len()],
            false => instants.kept.iter().map(|&k| resolution(raw[k], clock.unit)).collect(),
        };
        let (label, t) = (column.label(), &instants.t[..]);
        let written = |k: usize| column.written(rows[k]);
        let stamps = Stamps { column: &label, t, resolution: &resolution, written: &written, input_form };
        let start = match column.kind == Kind::Stamp || column.origin != 0 {
            true => 0.0,
            false => seconds.first().copied().unwrap_or(0.0),
        };
        let even = self.even(self.series(rows.clone()), &stamps, &instants);
        let even = even.map_err(|fault| self.with_other_clock(fault))?;
        let mut notes = instants.notes;
        notes.extend(clock.notes());
        notes.extend(even.notes);
        let mut doubts = even.doubts;
        doubts.extend(clock.doubt(&raw, even.sample_time, input_form));
        Ok(Even { start: if even.start.is_nan() { start } else { even.start }, notes, doubts, ..even })
    }

    /// Names a column that increases evenly, where the clock does not.
    fn with_other_clock(&self, (sample, mut problem): Fault) -> Fault {
        let Selection { time, input, output, .. } = *self.selection;
        let is_free = |k: &usize| ![time, Some(input), output].contains(&Some(*k));
        let is_even = |k: &usize| guess::is_ramp(self.column(*k)) && !guess::is_index(self.column(*k));
        if let DataProblem::NotIncreasing(step) = &mut problem
            && let Some(other) = (0..self.table.columns.len()).filter(is_free).find(is_even)
        {
            let Column { name, .. } = self.column(other);
            let by = if name.is_empty() { (other + 1).to_string() } else { name.clone() };
            let taken = self.request.input_form.with_time(&by);
            step.remedy =
                format!("take another clock, as {taken}, which increases evenly; or {}", step.remedy);
        }
        (sample, problem)
    }

    /// Whether the clock is the `t` beside `v` that the program itself writes, in seconds.
    fn is_own_form(&self, clock: &Column) -> bool {
        clock.name == "t" && self.column(self.selection.input).name == "v"
    }

    /// Stamps in order.
    fn instants(&self, rows: &[usize], (column, seconds): (&Column, &[f64])) -> Result<Instants, Fault> {
        let place = |k: usize| match self.table.places.get(rows[k]) {
            Place::Line(line) => format!("line {line}"),
            Place::Row(row) => format!("row {row}"),
        };
        let (label, stamp) = (column.label(), |k: usize| column.written(rows[k]));
        let input_form = self.request.input_form;
        Instants::of(seconds, &Written { column: &label, stamp: &stamp, place: &place, input_form })
    }

    /// Even samples of rows in order; the start is that of the stamps where it is no number.
    fn even(&self, series: Series, stamps: &Stamps<'_>, instants: &Instants) -> Result<Even, Fault> {
        let declared = self.request.sampling.sample_time;
        let at_kept = |(sample, problem): Fault| (sample.map(|k| instants.kept[k]), problem);
        if let Some(between) = self.request.sampling.resample {
            return self.resampled(series, stamps, (declared, between)).map_err(at_kept);
        }
        let sources = |jitter: f64| match declared {
            Some(_) => ClockSource::GivenAndTime,
            None => ClockSource::Time { jitter },
        };
        if let Some(sample_time) = self.leaves_out_what_stands(&series, stamps, declared) {
            return Ok(self.filled(&series, stamps, sample_time));
        }
        let judged = stamps.judge(declared);
        // A lost sample leaves all stamps behind it late; late stamps are followed by others in time.
        let is_plain = judged.as_ref().is_ok_and(|timing| timing.jitter <= JITTER);
        if !is_plain && let Some(counted) = self.counted(&series, stamps) {
            return Ok(counted);
        }
        let timing = judged.or_else(|fault| match fault {
            (_, DataProblem::Uneven(_)) => {
                let signals: Vec<&[f64]> =
                    std::iter::once(&series.v[..]).chain(series.y.as_deref()).collect();
                stamps.shaken(declared, &signals).ok_or(fault)
            }
            _ => Err(fault),
        });
        let timing = timing.map_err(at_kept)?;
        if timing.sample_time.is_nan() {
            let found = series.rows.len();
            return Err((None, DataProblem::TooShort { found, needed: samples_needed(None) }));
        }
        let reported = |&k: &usize| match series.rows[k] - series.rows[k - 1] {
            _ if instants.starts.contains(&k) => stamps.anew(k),
            1 => stamps.gap(k, timing.sample_time),
            _ => self.empty_cell(series.rows[k - 1] + 1),
        };
        let interruptions = timing.dropouts.iter().map(reported).collect();
        let pieces = pieces(&timing.dropouts, series.rows.len());
        let shaken = timing.shaken.map(|most| {
            format!(
                "the stamps of `{}` shake by up to {} sample times about even steps, but the signals do not: the rows are taken as even",
                stamps.column,
                rounded_share(most)
            )
        });
        Ok(Even {
            sample_time: timing.sample_time,
            start: f64::NAN,
            source: sources(timing.jitter),
            series,
            pieces,
            interruptions,
            notes: shaken.into_iter().collect(),
            doubts: Vec::new(),
        })
    }

    /// Samples by a column that counts them, where their stamps come late.
    fn counted(&self, series: &Series, stamps: &Stamps<'_>) -> Option<Even> {
        let counter = self.counter(&series.rows)?;
        let (counts, last) = (&counter.counts, counter.counts.len().checked_sub(1)?);
        if !counter.starts.is_empty() || last == 0 {
            return None;
        }
        let span = counts[last] - counts[0];
        let mean = (stamps.t[last] - stamps.t[0]) / span;
        // The ends may be as late as any stamp.
        let late = (0..=last).map(|k| (stamps.t[k] - stamps.t[0] - mean * (counts[k] - counts[0])).abs());
        let late = late.fold(0.0, f64::max);
        let given = self.request.sampling.sample_time;
        let sample_time = given.unwrap_or_else(|| nice(mean, late / span));
        let starts = counter.interruptions();
        let interruptions = starts.iter().map(|&k| stamps.gap(k, sample_time)).collect();
        let index = self.column(self.selection.index?).label();
        let note = format!(
            "the stamps of `{}` are off even steps by up to {} s: `{index}` counts the samples instead",
            stamps.column,
            rounded_share(late)
        );
        Some(Even {
            sample_time,
            start: f64::NAN,
            source: ClockSource::Counted,
            pieces: pieces(&starts, series.rows.len()),
            series: Series { rows: series.rows.clone(), ..self.series(series.rows.clone()) },
            interruptions,
            notes: vec![note],
            doubts: Vec::new(),
        })
    }

    /// The sample time of a logger that left out the rows in which nothing changed: steps are multiples of the shortest, and of signals that often
    /// stand still one by one no two rows are the same.
    fn leaves_out_what_stands(
        &self,
        series: &Series,
        stamps: &Stamps<'_>,
        declared: Option<f64>,
    ) -> Option<f64> {
        const LEAST: usize = 20;
        let y = series.y.as_ref()?;
        let same = |k: usize| (series.v[k] == series.v[k - 1], y[k] == y[k - 1]);
        let count =
            |wanted: &[(bool, bool)]| (1..series.v.len()).filter(|k| wanted.contains(&same(*k))).count();
        if count(&[(true, true)]) > 0 || 10 * count(&[(true, false), (false, true)]) <= series.v.len() {
            return None;
        }
        let (sample_time, gaps) = stamps.multiples(declared)?;
        (gaps >= LEAST && 20 * gaps > series.v.len()).then_some(sample_time)
    }

    /// The rows that were left out, each as the one before.
    fn filled(&self, series: &Series, stamps: &Stamps<'_>, sample_time: f64) -> Even {
        let longest = 0.5 * APART;
        let (even, pieces, _) = resample::resample(series, stamps.t, sample_time, (Between::Hold, longest));
        let note = format!(
            "{} rows in which nothing changed were not logged, and are filled with the values before",
            even.v.len() - series.v.len()
        );
        let interruptions =
            pieces.iter().skip(1).map(|piece| self.empty_cell(even.rows[piece.start])).collect();
        Even {
            sample_time,
            start: f64::NAN,
            source: ClockSource::Time { jitter: 0.0 },
            series: even,
            pieces,
            interruptions,
            notes: vec![note],
            doubts: Vec::new(),
        }
    }

    fn resampled(
        &self,
        series: Series,
        stamps: &Stamps<'_>,
        (declared, between): (Option<f64>, Between),
    ) -> Result<Even, Fault> {
        stamps.check_order()?;
        let too_short = DataProblem::TooShort { found: series.v.len(), needed: samples_needed(None) };
        let step = declared.or_else(|| stamps.mean_step()).ok_or((None, too_short))?;
        let (even, pieces, reported) =
            resample::resample(&series, stamps.t, step, (between, resample::BRIDGED));
        let interruptions =
            pieces.iter().skip(1).map(|piece| self.empty_cell(even.rows[piece.start])).collect();
        Ok(Even {
            sample_time: step,
            start: f64::NAN,
            source: ClockSource::Resampled(reported),
            series: even,
            pieces,
            interruptions,
            notes: Vec::new(),
            doubts: Vec::new(),
        })
    }

    fn no_sample_time(&self) -> DataProblem {
        let Request { names, input_form, .. } = self.request;
        let input = self.column(self.selection.input);
        if guess::stands_still(input) {
            return DataProblem::NeverMoves { column: input.label() };
        }
        let is_left_out = names.time.as_deref().is_some_and(|name| name.eq_ignore_ascii_case(NO_TIME));
        let unread = || guess::unread_time(&self.table.columns);
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

/// Two digits of a size.
fn rounded_share(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}
