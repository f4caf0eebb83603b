//! Which columns of a table are time, input and output.

use super::guess::{self, Part};
use super::input_form::InputForm;
use super::names::{ColumnNames, NO_TIME};
use crate::closest;
use crate::table::{Column, DataProblem, Kind, Table};

/// The columns taken, as positions in the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selection {
    /// The clock.
    pub time: Option<usize>,
    /// A column that counts the samples, where there is no time.
    pub index: Option<usize>,
    /// The input.
    pub input: usize,
    /// None where the table offers none; only an input's file may.
    pub output: Option<usize>,
    /// Another simulator's prediction, `y_sim`.
    pub prediction: Option<usize>,
    /// Columns that could be the input or output instead.
    pub rivals: Vec<usize>,
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
        let index = (0..table.columns.len()).filter(free).find(|&k| guess::is_index(&table.columns[k]));
        let is_signal = |k: &usize| {
            free(k) && Some(*k) != time && Some(*k) != index && table.columns[*k].is_number()
                // With no time column wanted, what is one all the same is no signal.
                && !(has_no_time && is_clock(&table.columns[*k]))
        };
        let signals: Vec<usize> = (0..table.columns.len()).filter(is_signal).collect();
        let offer = Offer { table, signals: &signals, input_form };
        let (input, output) = offer.settle(input, output, needs_output).map_err(|problem| vec![problem])?;
        let output = output.filter(|_| !has_no_output);
        let rival = |k: &usize| {
            let column = &table.columns[*k];
            Some(*k) != output
                && *k != input
                && [Part::Input, Part::Motion, Part::Output]
                    .into_iter()
                    .any(|part| guess::surety(column, part).is_some())
        };
        let rivals = signals.iter().copied().filter(rival).collect();
        Ok(Self { time, index: index.filter(|_| time.is_none()), input, output, prediction, rivals })
    }
}

/// The column that a name means: as it stands in the header, else without its unit, else in another case, else by position.
fn find(table: &Table, asked: &str) -> Result<usize, DataProblem> {
    let simple = guess::simplified(asked);
    let levels: [&dyn Fn(&Column) -> bool; 4] = [
        &|column| column.label() == asked,
        &|column| column.name == asked,
        &|column| guess::simplified(&column.label()) == simple,
        &|column| guess::simplified(&column.name) == simple,
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

/// The time column: the one that is called so, else the one with time stamps, else the only one that rises evenly.
fn clock(table: &Table, free: &impl Fn(&usize) -> bool) -> Option<usize> {
    let columns = || (0..table.columns.len()).filter(free).filter(|&k| table.columns[k].kind != Kind::Text);
    let called = columns()
        .filter_map(|k| Some((guess::surety(&table.columns[k], Part::Time)?, k)))
        .max_by_key(|(surety, k)| (*surety, std::cmp::Reverse(*k)));
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
    called.map(|(_, k)| k).or_else(stamps).or_else(ramp)
}

fn is_clock(column: &Column) -> bool {
    guess::surety(column, Part::Time).is_some() || column.kind == Kind::Stamp || guess::is_ramp(column)
}

/// The columns that can be input or output.
struct Offer<'a> {
    table: &'a Table,
    signals: &'a [usize],
    input_form: &'a InputForm,
}

impl Offer<'_> {
    fn settle(
        &self,
        input: Option<usize>,
        output: Option<usize>,
        needs_output: bool,
    ) -> Result<(usize, Option<usize>), DataProblem> {
        let rest = |other: Option<usize>| self.signals.iter().copied().filter(move |k| Some(*k) != other);
        let is_guessed = input.is_none() || output.is_none();
        let mut output = output.or_else(|| self.called(Part::Output));
        let mut input = input.or_else(|| self.called(Part::Input));
        // One is known and one is left.
        if let (Some(_), None) = (input, output) {
            output = only(rest(input));
        }
        if let (None, Some(_)) = (input, output) {
            input = self.called(Part::Motion).filter(|k| Some(*k) != output).or_else(|| only(rest(output)));
        }
        if let (None, None, [first, second]) = (input, output, self.signals)
            && !self.table.has_header
        {
            (input, output) = (Some(*first), Some(*second));
        }
        if !needs_output && input.is_none() {
            input = self.called(Part::Motion).or_else(|| only(rest(None)));
        }
        match (input, output) {
            // Two columns of one name are distinguished by number only.
            (Some(input), Some(output)) if is_guessed && self.share_a_name(input, output) => {
                Err(self.doubt(None, None))
            }
            (Some(input), output) if output.is_some() || !needs_output => Ok((input, output)),
            (Some(input), None) if self.signals == [input] => {
                Err(DataProblem::NotMeasured { input: self.table.columns[input].label() })
            }
            _ => Err(self.doubt(input, output)),
        }
    }

    /// The column whose name says it most surely, the first of several.
    fn called(&self, part: Part) -> Option<usize> {
        let of = |k: usize| Some((guess::surety(&self.table.columns[k], part)?, std::cmp::Reverse(k)));
        self.signals.iter().filter_map(|&k| of(k)).max().map(|(_, k)| k.0)
    }

    fn doubt(&self, input: Option<usize>, output: Option<usize>) -> DataProblem {
        let role = match (input, output) {
            (None, None) => "the input and which the output",
            (None, _) => "the input",
            _ => "the output",
        };
        let mut left = self.signals.iter().copied().filter(|k| Some(*k) != input && Some(*k) != output);
        let mut name = |known: Option<usize>| match known.or_else(|| left.next()) {
            Some(k) if self.table.has_header && self.is_unique(k) => self.table.columns[k].name.clone(),
            Some(k) => (k + 1).to_string(),
            None => "NAME".to_owned(),
        };
        let wanted = [("input", name(input)), ("output", name(output))];
        let remedy = if self.signals.len() < 2 {
            "a record needs an input and an output, one number each in every row, beside the time".to_owned()
        } else {
            self.input_form.naming(&wanted)
        };
        DataProblem::Doubtful { role: role.to_owned(), known: self.table.listing(), remedy }
    }

    fn share_a_name(&self, a: usize, b: usize) -> bool {
        let name = |k: usize| guess::simplified(&self.table.columns[k].name);
        self.table.has_header && name(a) == name(b)
    }

    fn is_unique(&self, k: usize) -> bool {
        let name = &self.table.columns[k].name;
        !name.is_empty() && self.table.columns.iter().filter(|column| column.name == *name).count() == 1
    }
}

fn only(mut columns: impl Iterator<Item = usize>) -> Option<usize> {
    columns.next().filter(|_| columns.next().is_none())
}
