//! Which columns of a table are time, input and output.

use super::guess::{self, Part, Surety};
use super::input_form::InputForm;
use super::names::{ColumnNames, NO_TIME};
use super::offer::Offer;
use super::settle::{Settled, settle};
use super::spelling::simplified;
use crate::closest;
use crate::table::{Column, DataProblem, Kind, Table, unit};

/// The columns taken, as positions in the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    /// The clock.
    pub time: Option<usize>,
    /// A column that counts the samples.
    pub index: Option<usize>,
    /// The input.
    pub input: usize,
    /// None where the table offers none; only an input's file may.
    pub output: Option<usize>,
    /// Another simulator's prediction, `y_sim`.
    pub prediction: Option<usize>,
    /// Columns that could be the input or output instead.
    pub rivals: Vec<usize>,
    /// Why input and output may be the other way round.
    pub doubt: Option<String>,
}

/// In place of an output's name: an input's file has none that counts.
const NO_OUTPUT: &str = "none";

/// Name of the column with another simulator's prediction.
const PREDICTION: &str = "y_sim";

impl Selection {
    /// Finds the columns named, guesses the others.
    ///
    /// # Errors
    /// All that is wrong with the names given, or what cannot be guessed without doubt.
    pub fn of(
        table: &Table,
        names: &ColumnNames,
        input_form: &InputForm,
        needs_output: bool,
    ) -> Result<Self, Vec<DataProblem>> {
        let mut problems = Vec::new();
        let mut named = |name: &Option<String>| {
            name.as_ref().and_then(|name| find(table, name).map_err(|problem| problems.push(problem)).ok())
        };
        let has_no_time = names.time.as_deref().is_some_and(|name| name.eq_ignore_ascii_case(NO_TIME));
        let time = if has_no_time { None } else { named(&names.time) };
        let is_none = |name: &String| name.eq_ignore_ascii_case(NO_OUTPUT);
        let has_no_output = !needs_output && names.output.as_ref().is_some_and(is_none);
        let asked = if has_no_output { &None } else { &names.output };
        let (input, output) = (named(&names.input), named(asked));
        let prediction = prediction(table).unwrap_or_else(|problem| {
            problems.push(problem);
            None
        });
        problems.extend(shared(table, [("time", time), ("input", input), ("output", output)]));
        if !problems.is_empty() {
            return Err(problems);
        }
        let taken: Vec<usize> = [time, input, output, prediction].into_iter().flatten().collect();
        let free = |k: &usize| !taken.contains(k);
        // A single column is a signal, however evenly it rises.
        let has_clock = !has_no_time && table.columns.len() > 1;
        let time = time.or_else(|| if has_clock { clock(table, &free) } else { None });
        let column = |k: &usize| &table.columns[*k];
        let columns = || (0..table.columns.len()).filter(free);
        let index = columns().filter(|k| Some(*k) != time).find(|k| guess::is_index(column(k)));
        let is_signal = |k: &usize| {
            let is_other = guess::is_index(column(k))
                || guess::is_part_number(column(k))
                || is_other_clock(column(k))
                // With no time column wanted, what is one all the same is no signal.
                || has_no_time && is_clock(column(k));
            Some(*k) != time && column(k).is_number() && !is_other
        };
        let signals: Vec<usize> = columns().filter(is_signal).collect();
        let moving: Vec<usize> =
            signals.iter().copied().filter(|k| !guess::stands_still(column(k))).collect();
        if moving.is_empty() && signals.len() > 2 && input.is_none() && output.is_none() {
            let columns =
                signals.iter().map(|k| format!("`{}`", column(k).label())).collect::<Vec<_>>().join(", ");
            return Err(vec![DataProblem::NothingMoves { columns }]);
        }
        // Of many columns those that stand still are settings.
        let offered = if moving.len() >= 2 { moving } else { signals.clone() };
        let signals_proper: Vec<usize> =
            offered.iter().copied().filter(|k| !guess::is_feed(column(k))).collect();
        let offered = if signals_proper.len() >= 2 { signals_proper } else { offered };
        let offer = Offer { table, signals: &offered, input_form };
        let Settled { input, output, doubt, others } =
            settle(&offer, (input, output), needs_output).map_err(|problem| vec![problem])?;
        let output = output.filter(|_| !has_no_output);
        let rival = |k: &usize| {
            Some(*k) != output
                && *k != input
                && !guess::stands_still(column(k))
                && (others.contains(k)
                    || [Part::Input, Part::Motion, Part::Output, Part::Command]
                        .into_iter()
                        .any(|part| guess::surety(column(k), part).is_some()))
        };
        let rivals = signals.iter().copied().filter(rival).collect();
        Ok(Self { time, index, input, output, prediction, rivals, doubt })
    }
}

/// The column that a name means: as it stands in the header, else without its unit, else in another case, else by position.
fn find(table: &Table, asked: &str) -> Result<usize, DataProblem> {
    let simple = simplified(asked);
    let levels: [&dyn Fn(&Column) -> bool; 4] = [
        &|column| column.label() == asked,
        &|column| column.name == asked,
        &|column| simplified(&column.label()) == simple,
        &|column| simplified(&column.name) == simple,
    ];
    for is_meant in levels {
        let found: Vec<usize> = (0..table.columns.len()).filter(|&k| is_meant(&table.columns[k])).collect();
        match found[..] {
            [] => {}
            [only] => return Ok(only),
            _ => return Err(DataProblem::DuplicateColumn { column: asked.to_owned(), times: found.len() }),
        }
    }
    if let Some(k) = asked.parse::<usize>().ok().filter(|k| (1..=table.columns.len()).contains(k)) {
        return Ok(k - 1);
    }
    let names: Vec<(String, &Column)> =
        table.columns.iter().map(|column| (column.name.to_lowercase(), column)).collect();
    let meant = closest(&asked.to_lowercase(), names.iter().map(|(name, _)| name.as_str()));
    let meant = meant.and_then(|meant| names.iter().find(|(name, _)| name == meant));
    Err(DataProblem::UnknownColumn {
        asked: asked.to_owned(),
        known: table.listing(),
        meant: meant.filter(|_| table.has_header).map(|(_, column)| column.name.clone()),
    })
}

fn prediction(table: &Table) -> Result<Option<usize>, DataProblem> {
    let all = || table.columns.iter().map(|column| column.name.as_str()).enumerate();
    let found: Vec<usize> = all().filter(|(_, name)| *name == PREDICTION).map(|(k, _)| k).collect();
    if found.len() > 1 {
        return Err(DataProblem::DuplicateColumn { column: PREDICTION.to_owned(), times: found.len() });
    }
    // Ignoring a misspelt `y_sim` would silently diagnose another model than the user's.
    let letters = |name: &str| name.to_lowercase().replace(['_', '-', ' '], "");
    match all().find(|(_, name)| *name != PREDICTION && letters(name) == "ysim") {
        Some((_, found)) => Err(DataProblem::LookAlike { found: found.to_owned(), meant: PREDICTION }),
        None => Ok(found.first().copied()),
    }
}

fn shared(table: &Table, parts: [(&'static str, Option<usize>); 3]) -> Vec<DataProblem> {
    let mut problems = Vec::new();
    for (i, (first, column)) in parts.iter().enumerate() {
        for (second, other) in &parts[i + 1..] {
            if let (Some(column), true) = (column, column == other) {
                let column = table.columns[*column].label();
                problems.push(DataProblem::SameColumn { column, first, second });
            }
        }
    }
    problems
}

/// The time column: the one that is called so and increases, else the one with time stamps, else the only one that rises evenly.
fn clock(table: &Table, free: &impl Fn(&usize) -> bool) -> Option<usize> {
    let columns = || (0..table.columns.len()).filter(free).filter(|&k| table.columns[k].kind != Kind::Text);
    // A number that changes at midnight, beside the time of day.
    let stamped = columns()
        .map(|k| &table.columns[k])
        .find(|column| column.kind == Kind::Stamp && guess::goes_on(column));
    let is_date = |column: &Column| {
        let changes = guess::changes(column);
        column.kind == Kind::Number
            && 20 * changes < column.values.len()
            && stamped.is_some_and(|stamped| guess::changes(stamped) > changes)
    };
    let can_be = |column: &Column| {
        let is_ruled_out = || guess::is_duration(column) && !guess::is_ramp(column);
        guess::goes_on(column) && !guess::is_index(column) && !is_ruled_out() && !is_date(column)
    };
    let called = columns().filter(|&k| can_be(&table.columns[k])).filter_map(|k| {
        let column = &table.columns[k];
        let surety = guess::surety(column, Part::Time)?;
        let rank = (guess::increases(column), !guess::is_duration(column), surety, std::cmp::Reverse(k));
        Some((rank, k))
    });
    let called = called.max_by_key(|(rank, _)| *rank);
    let increasing = called.filter(|((increases, ..), _)| *increases).map(|(_, k)| k);
    let stamps = || columns().find(|&k| table.columns[k].kind == Kind::Stamp);
    let ramp = || {
        let is_free_ramp = |k: &usize| {
            let column = &table.columns[*k];
            guess::is_ramp(column)
                && !guess::is_index(column)
                && [Part::Input, Part::Motion, Part::Output]
                    .into_iter()
                    .all(|part| guess::surety(column, part).is_none())
        };
        let mut ramps = columns().filter(is_free_ramp);
        ramps.next().filter(|_| ramps.next().is_none())
    };
    increasing.or_else(stamps).or_else(ramp).or(called.map(|(_, k)| k))
}

fn is_clock(column: &Column) -> bool {
    guess::surety(column, Part::Time).is_some() || column.kind == Kind::Stamp || guess::is_ramp(column)
}

/// Whether a column is the clock of some signals only.
fn is_other_clock(column: &Column) -> bool {
    let name = guess::surety(column, Part::Time);
    let has_unit = column.unit.as_deref().is_some_and(|unit| unit::seconds(unit).is_some());
    name == Some(Surety::Name)
        || name.is_some() && (has_unit || guess::is_ramp(column))
        || guess::is_duration(column)
        || column.kind == Kind::Stamp
}
