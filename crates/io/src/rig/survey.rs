//! What a rig file says of files too long to be held in memory: their first rows show columns and clock, the others are looked at part by part.

use super::assemble::{Loaded, assemble_tables};
use super::plan::{Plan, PlannedRecord};
use super::problem::{RigError, RigProblem};
use super::reported::{Reported, held_out_of};
use crate::input::stream;
use std::path::Path;
use switchback_table::signals::{Measured, Request, spikes};
use switchback_table::table::{DataError, Place, Table, TableError};

/// Bytes from which on a file is not read whole.
const LONG: u64 = 32 << 20;
/// Rows looked at together: some megabytes, and more than most clocks need to show their rate.
const PART: usize = 1 << 16;

/// What was inferred, and reported.
#[derive(Debug)]
pub struct Survey {
    /// The plan with all that was inferred.
    pub plan: Plan,
    /// What was inferred, to be reported.
    pub reported: Reported,
}

impl From<Loaded> for Survey {
    fn from(Loaded { plan, reported, .. }: Loaded) -> Self {
        Self { plan, reported }
    }
}

/// A file that was looked at.
#[derive(Default)]
struct Seen {
    samples: usize,
    dropouts: usize,
    first: Option<DataError>,
    parts: usize,
    warnings: Vec<String>,
}

/// Whether a plan's files are better looked at part by part.
pub(super) fn is_for(plan: &Plan) -> bool {
    let is_long = |path: &Path| path.metadata().is_ok_and(|file| file.len() > LONG);
    plan.records.iter().any(|record| !stream::is_stream(&record.path) && is_long(&record.path))
}

/// Looks at the files; none where they must be read whole, since their first rows do not show what they are.
///
/// # Errors
/// [`RigError`] with what is wrong in the first part that is.
pub(super) fn look(plan: &Plan) -> Result<Option<Survey>, RigError> {
    let heads: Vec<Table> = plan.records.iter().map_while(head).collect();
    if heads.len() < plan.records.len() {
        return Ok(None);
    }
    let Ok(loaded) = assemble_tables(plan, heads) else { return Ok(None) };
    let Loaded { plan: resolved, mut reported, .. } = loaded;
    let mut seen = Vec::new();
    for record in &resolved.records {
        let Some(of) = look_at(&resolved, record)? else { return Ok(None) };
        seen.push(of);
    }
    reported.held_out = reported.held_out.map(|_| {
        let counts: Vec<usize> = seen.iter().map(|seen| seen.samples).collect();
        held_out_of(plan, &counts)
    });
    for (record, seen) in resolved.records.iter().zip(&seen) {
        reported.notes.push(seen.note(&record.named));
        let new = |warning: &&String| !reported.warnings.contains(warning);
        let new: Vec<String> = seen.warnings.iter().filter(new).cloned().collect();
        reported.warnings.extend(new);
    }
    Ok(Some(Survey { plan: resolved, reported }))
}

/// The first rows of a file.
fn head(record: &PlannedRecord) -> Option<Table> {
    let mut first = None;
    let is_read = Table::batches(&record.path, (2, PART), &mut |table| {
        first = Some(table);
        false
    });
    first.filter(|_| matches!(is_read, Ok(true)))
}

/// Looks at all parts of a file, in the terms of a plan that leaves nothing to be guessed.
fn look_at(plan: &Plan, record: &PlannedRecord) -> Result<Option<Seen>, RigError> {
    let names = record.columns.or(&plan.columns);
    let request =
        Request { names: &names, sampling: plan.sampling, input_form: &plan.input_form, needs_output: true };
    let mut seen = Seen::default();
    let mut wrong: Vec<TableError> = Vec::new();
    let is_read = Table::batches(&record.path, (2, PART), &mut |table| {
        // A last part of a row or two shows no clock.
        if table.places.len() < 10 && seen.parts > 0 {
            seen.samples += table.places.len();
            return true;
        }
        match Measured::of(table, request) {
            Ok(measured) => seen.add(&measured),
            Err(problems) => wrong = problems,
        }
        wrong.is_empty()
    });
    if !wrong.is_empty() {
        return Err(RigError::new(wrong.into_iter().map(RigProblem::from).collect()));
    }
    Ok(is_read?.then_some(seen))
}

impl Seen {
    fn add(&mut self, measured: &Measured) {
        self.samples += measured.v.len();
        self.dropouts += measured.pieces.len().saturating_sub(1);
        self.parts += 1;
        if self.first.is_none() {
            self.first = measured.first_interruption();
        }
        if self.warnings.len() < 3 {
            self.warnings.extend(spikes(measured));
        }
    }

    fn note(&self, named: &str) -> String {
        let Self { samples, parts, dropouts, .. } = self;
        let place = match self.first.as_ref().and_then(|first| first.place) {
            Some(Place::Line(line)) => format!("; {dropouts} dropouts, the first at line {line}"),
            Some(Place::Row(row)) => format!("; {dropouts} dropouts, the first at row {row}"),
            None => String::new(),
        };
        format!(
            "{named}: long; {samples} samples looked at in {parts} parts, the first of which shows columns and clock{place}"
        )
    }
}
