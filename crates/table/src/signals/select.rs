//! Which columns of a table are time, input and output.

use super::causality::Precedence;
use super::guess::{self, Part, Surety};
use super::input_form::InputForm;
use super::names::{ColumnNames, NO_TIME};
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
        let offered = if moving.len() >= 2 { &moving } else { &signals };
        let offer = Offer { table, signals: offered, input_form };
        let (input, output, doubt) =
            offer.settle(input, output, needs_output).map_err(|problem| vec![problem])?;
        let output = output.filter(|_| !has_no_output);
        let rival = |k: &usize| {
            Some(*k) != output
                && *k != input
                && [Part::Input, Part::Motion, Part::Output, Part::Command]
                    .into_iter()
                    .any(|part| guess::surety(column(k), part).is_some())
        };
        let rivals = signals.iter().copied().filter(rival).collect();
        Ok(Self { time, index, input, output, prediction, rivals, doubt })
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
        .filter(|&k| guess::goes_on(&table.columns[k]) && !guess::is_index(&table.columns[k]))
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

/// Whether a column is the clock of some signals only.
fn is_other_clock(column: &Column) -> bool {
    let name = guess::surety(column, Part::Time);
    let has_unit = column.unit.as_deref().is_some_and(|unit| unit::seconds(unit).is_some());
    name == Some(Surety::Name)
        || name.is_some() && (has_unit || guess::is_ramp(column))
        || column.kind == Kind::Stamp
}

/// The columns that can be input or output.
struct Offer<'a> {
    table: &'a Table,
    signals: &'a [usize],
    input_form: &'a InputForm,
}

/// Input, output, and why they may be the other way round.
type Settled = (usize, Option<usize>, Option<String>);

impl Offer<'_> {
    fn settle(
        &self,
        input: Option<usize>,
        output: Option<usize>,
        needs_output: bool,
    ) -> Result<Settled, DataProblem> {
        let rest = |other: Option<usize>| self.signals.iter().copied().filter(move |k| Some(*k) != other);
        let is_guessed = input.is_none() || output.is_none();
        let is_none = input.is_none() && output.is_none();
        let (mut input, mut output) = self.paired(input, output);
        output = output.or_else(|| self.called(&[Part::Output, Part::Response], input));
        input = input.or_else(|| self.called(&[Part::Input, Part::Command], output));
        if input.is_none() && output.is_none() {
            (input, output) = match (self.called(&[Part::Drive], None), self.called(&[Part::Answer], None)) {
                (Some(drive), Some(answer)) if drive != answer => (Some(drive), Some(answer)),
                _ => (None, None),
            };
        }
        // One is known and one is left.
        if let (Some(_), None) = (input, output) {
            output = only(rest(input)).or_else(|| input.and_then(|input| self.answer_of(input)));
        }
        if let (None, Some(_)) = (input, output) {
            let motion = || self.called(&[Part::Motion], output);
            let drive = || self.called(&[Part::Drive], output);
            input = motion().or_else(|| only(rest(output))).or_else(drive);
        }
        let mut doubt = None;
        let shares = |pair: (Option<usize>, Option<usize>)| matches!(pair, (Some(input), Some(output)) if is_guessed && self.share_a_name(input, output));
        if is_none && shares((input, output)) {
            (input, output) = (None, None);
        }
        if let (None, None, [first, second], true) = (input, output, self.signals, needs_output) {
            let settled = self.by_causality(*first, *second);
            (input, output, doubt) = settled.map_or((None, None, None), |(input, output, doubt)| {
                (Some(input), Some(output), Some(doubt))
            });
        }
        if !needs_output && input.is_none() {
            input = self.called(&[Part::Motion], None).or_else(|| only(rest(None)));
        }
        match (input, output) {
            // Two columns of one name are distinguished by number only.
            (Some(input), Some(output))
                if is_guessed && doubt.is_none() && self.share_a_name(input, output) =>
            {
                Err(self.doubt(None, None))
            }
            (Some(input), output) if output.is_some() || !needs_output => Ok((input, output, doubt)),
            (Some(input), None) if self.signals == [input] => {
                Err(DataProblem::NotMeasured { input: self.table.columns[input].label() })
            }
            _ => Err(self.doubt(input, output)),
        }
    }

    /// A command and its response, which are called alike but for that word: `target pos (5)` and `pos (5)`.
    fn paired(&self, input: Option<usize>, output: Option<usize>) -> (Option<usize>, Option<usize>) {
        let column = |k: usize| &self.table.columns[k];
        let pairs = self.signals_and(input).into_iter().flat_map(|command| {
            let base = guess::without(column(command), Part::Command);
            self.signals_and(output).into_iter().filter_map(move |response| {
                let (base, other) = (base.clone()?, column(response));
                let is_other = response != command && guess::without(other, Part::Command).is_none();
                let plain = guess::without(other, Part::Response).unwrap_or_else(|| guess::named(other));
                (is_other && (plain == base || guess::named(other) == base)).then_some((command, response))
            })
        });
        let is_meant = |given: Option<usize>, k: usize| given.is_none_or(|given| given == k);
        let mut fitting =
            pairs.filter(|(command, response)| is_meant(input, *command) && is_meant(output, *response));
        match fitting.next() {
            Some((command, response)) => (Some(command), Some(response)),
            None => (input, output),
        }
    }

    /// What moves by a command, called as it is but for such a word: `throttle_cmd` and `throttle_pos`. A position comes before a speed.
    fn answer_of(&self, command: usize) -> Option<usize> {
        let column = |k: usize| &self.table.columns[k];
        let base = guess::without(column(command), Part::Command)?;
        let moved = |part: Part| {
            let is = |k: &usize| *k != command && guess::without(column(*k), part).as_ref() == Some(&base);
            only(self.signals.iter().copied().filter(is))
        };
        moved(Part::Motion).or_else(|| moved(Part::Answer))
    }

    /// The signals, or the one that the user named.
    fn signals_and(&self, given: Option<usize>) -> Vec<usize> {
        given.map_or_else(|| self.signals.to_vec(), |given| vec![given])
    }

    /// Both directions, tried: the input is the one whose past says what the other does next. The order in the file decides where neither does.
    fn by_causality(&self, first: usize, second: usize) -> Option<(usize, usize, String)> {
        let column = |k: usize| &self.table.columns[k];
        let rows: Vec<usize> = (0..self.table.places.len())
            .filter(|&row| column(first).values[row].is_finite() && column(second).values[row].is_finite())
            .collect();
        let of = |k: usize| -> Vec<f64> { rows.iter().map(|&row| column(k).values[row]).collect() };
        let precedence = Precedence::of(&of(first), &of(second));
        if precedence.is_none() && self.table.has_header {
            return None;
        }
        let (input, output) = match precedence {
            Some(precedence) if !precedence.is_forward() => (second, first),
            _ => (first, second),
        };
        let shown = |k: usize| match self.table.has_header && self.is_unique(k) {
            true => format!("`{}`", column(k).label()),
            false => format!("column {}", k + 1),
        };
        let why = match precedence {
            Some(_) => format!(
                "{} is taken for the input, since its past predicts {} better than the other way round",
                shown(input),
                shown(output)
            ),
            None => format!("{} is taken for the input, as the first", shown(input)),
        };
        let other = self.input_form.naming(&[("input", self.name(output)), ("output", self.name(input))]);
        Some((
            input,
            output,
            format!("no name says which column is the input: {why}; if that is wrong, {other}"),
        ))
    }

    /// The column whose name says most surely that it is one of these parts, the first of several; the first part named counts most.
    ///
    /// Words that all signals share say nothing, a command is no output, and a signal in its unit is better than the same one in volts.
    fn called(&self, parts: &[Part], taken: Option<usize>) -> Option<usize> {
        let column = |k: usize| &self.table.columns[k];
        let is_raw =
            |k: usize| self.signals.iter().any(|&other| guess::is_raw_form(column(k), column(other)));
        let is_out = parts.contains(&Part::Output);
        let of = |k: usize, part: Part| {
            let says_nothing = || self.is_shared(k, part);
            let is_command = is_out
                && guess::surety(column(k), Part::Command).is_some()
                && !self.is_shared(k, Part::Command)
                || is_out && guess::is_of_controller(column(k));
            let surety = guess::surety(column(k), part).filter(|_| !is_command && !says_nothing())?;
            Some((surety, !is_raw(k), std::cmp::Reverse(k)))
        };
        let free = || self.signals.iter().copied().filter(|k| Some(*k) != taken);
        let of_part = |part: &Part| free().filter_map(|k| of(k, *part)).max();
        // The whole name of any part counts more than a word.
        let found: Vec<_> = parts.iter().filter_map(of_part).collect();
        let named = found.iter().find(|(surety, ..)| *surety == Surety::Name);
        named.or(found.first()).map(|(.., k)| k.0)
    }

    /// Whether the words by which a column would be this part stand in the names of all signals.
    fn is_shared(&self, k: usize, part: Part) -> bool {
        let name = guess::named(&self.table.columns[k]);
        let Some(others) = guess::without(&self.table.columns[k], part) else { return false };
        let mut deciding = name.iter().filter(|word| !others.contains(word));
        let in_all = |word: &String| {
            self.signals.iter().all(|&other| guess::named(&self.table.columns[other]).contains(word))
        };
        self.signals.len() > 1 && deciding.all(in_all)
    }

    /// By what a column is named on the command line.
    fn name(&self, k: usize) -> String {
        match self.table.has_header && self.is_unique(k) {
            true => self.table.columns[k].name.clone(),
            false => (k + 1).to_string(),
        }
    }

    fn doubt(&self, input: Option<usize>, output: Option<usize>) -> DataProblem {
        let role = match (input, output) {
            (None, None) => "the input and which the output",
            (None, _) => "the input",
            _ => "the output",
        };
        // An example that guessed would be copied.
        let name = |known: Option<usize>| known.map_or_else(|| "NAME".to_owned(), |k| self.name(k));
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
