//! The columns that can be input or output, and what their names and units say.

use super::guess::{self, Part, Quantity, Surety};
use super::input_form::InputForm;
use super::pairs::{Commanded, Likeness, pairs};
use super::spelling::simplified;
use super::words::{self, Words};
use crate::table::{Column, DataProblem, Table};
use std::collections::{BTreeSet, HashSet};

/// The columns that can be input or output.
pub(super) struct Offer<'a> {
    pub(super) table: &'a Table,
    pub(super) signals: &'a [usize],
    pub(super) input_form: &'a InputForm,
}

/// An input and an output, as far as names and units say.
#[derive(Debug, Clone, Default)]
pub(super) struct Choice {
    pub(super) input: Option<usize>,
    pub(super) output: Option<usize>,
    /// Whether both are called alike but for words for a command and its response.
    pub(super) is_pair: bool,
    /// Whether only a word or a unit says so that means little by itself.
    pub(super) is_weak: bool,
    /// Other commands with their responses.
    pub(super) other_pairs: Vec<Commanded>,
    /// What is called a response, but of another quantity than the command.
    pub(super) unlike: Option<usize>,
}

impl Offer<'_> {
    pub(super) fn column(&self, k: usize) -> &Column {
        &self.table.columns[k]
    }

    /// What names say, then units, then what is left where one is known.
    pub(super) fn by_names(&self, input: Option<usize>, output: Option<usize>) -> Choice {
        let rest = |other: Option<usize>| self.signals.iter().copied().filter(move |k| Some(*k) != other);
        let is_given = output.is_some();
        let mut choice = self.paired(input, output);
        let Choice { input, output, is_weak, unlike, .. } = &mut choice;
        *output = output.or_else(|| self.called(&[Part::Output, Part::Response], *input));
        *input = input.or_else(|| self.commanded(*output));
        if let (Some(command), Some(called), false) = (*input, *output, is_given)
            && let Some(own) = self.of_own_quantity(command, called)
        {
            (*output, *unlike) = (Some(own), Some(called));
        }
        if input.is_none() && output.is_none() {
            (*input, *output) = match (self.called(&[Part::Drive], None), self.called(&[Part::Answer], None))
            {
                (Some(drive), Some(answer)) if drive != answer => (Some(drive), Some(answer)),
                _ => (None, None),
            };
        }
        if output.is_none() && self.moves(*input) {
            *output = self.in_unit(words::UNITS_OF_FORCE, *input);
            *is_weak |= output.is_some();
        }
        // One is known and one is left.
        if let (Some(known), None) = (*input, *output) {
            *output = only(rest(*input)).or_else(|| self.answer_of(known));
        }
        if let (None, Some(_)) = (*input, *output) {
            *input = self.called(&[Part::Motion], *output).or_else(|| only(rest(*output)));
            *is_weak |= input.is_none();
            let motion = || self.in_unit(words::UNITS_OF_MOTION, *output);
            *input = input.or_else(motion).or_else(|| self.called(&[Part::Drive], *output));
        }
        choice
    }

    /// What is called an input or a command: one that says where the machine should be comes before what a controller gives out.
    fn commanded(&self, output: Option<usize>) -> Option<usize> {
        let found = self.called(&[Part::Input, Part::Command], output)?;
        if guess::is_reference(self.column(found)) {
            return Some(found);
        }
        let is_other = |k: &usize| Some(*k) != output && guess::is_reference(self.column(*k));
        only(self.signals.iter().copied().filter(is_other)).or(Some(found))
    }

    /// The signal of a command's own quantity, where what is called a response is of another one: `pos` for `input_pos` beside `Iq_measured`.
    /// Of several it is the one whose name shares most words with the command's.
    fn of_own_quantity(&self, command: usize, called: usize) -> Option<usize> {
        let quantity = |k: usize| guess::quantity(self.column(k));
        let is = |k: usize, part: Part| guess::surety(self.column(k), part).is_some();
        let is_answer = is(called, Part::Response)
            && (!is(called, Part::Output) || guess::is_reference(self.column(command)));
        let is_unlike = ![quantity(command), Quantity::Unknown].contains(&quantity(called));
        if !is_answer || !is_unlike || quantity(command) == Quantity::Unknown || !is(command, Part::Command) {
            return None;
        }
        let is_free = |k: &usize| {
            *k != command
                && quantity(*k) == quantity(command)
                && !is(*k, Part::Command)
                && !guess::is_of_controller(self.column(*k))
                && !guess::is_deviation(self.column(*k))
        };
        let asked = guess::named(self.column(command));
        let shared =
            |k: &usize| guess::named(self.column(*k)).iter().filter(|word| asked.contains(word)).count();
        self.signals.iter().copied().filter(is_free).max_by_key(|k| (shared(k), std::cmp::Reverse(*k)))
    }

    /// Another column that is called an input, and nothing else.
    pub(super) fn other_input(&self, input: usize) -> Option<usize> {
        let is_called = |k: usize| guess::surety(self.column(k), Part::Input) == Some(Surety::Name);
        let is_free = |k: &usize| *k != input && is_called(*k) && !is_called(input);
        self.signals.iter().copied().find(is_free)
    }

    /// Whether a column is a command, or drives a machine, rather than a motion.
    pub(super) fn drives(&self, k: usize) -> bool {
        let is = |part: Part| guess::surety(self.column(k), part).is_some();
        (is(Part::Command) || is(Part::Input) || is(Part::Drive)) && !is(Part::Motion)
    }

    /// Whether the input is a motion, or one of the signals where it is not known.
    fn moves(&self, input: Option<usize>) -> bool {
        let is_motion = |k: usize| {
            let column = self.column(k);
            guess::surety(column, Part::Motion).is_some() || guess::is_in(column, words::UNITS_OF_MOTION)
        };
        match input {
            Some(input) => is_motion(input) && guess::surety(self.column(input), Part::Command).is_none(),
            None => self.signals.iter().any(|k| is_motion(*k)),
        }
    }

    /// The only signal in a unit of these.
    fn in_unit(&self, units: Words, taken: Option<usize>) -> Option<usize> {
        let is_free = |k: &usize| Some(*k) != taken && guess::is_in(self.column(*k), units);
        only(self.signals.iter().copied().filter(is_free))
    }

    /// A command and its response, the likeliest of several.
    fn paired(&self, input: Option<usize>, output: Option<usize>) -> Choice {
        let all = pairs(self.table, &self.signals_and(input), &self.signals_and(output));
        let Some((first, others)) = all.split_first() else {
            return Choice { input, output, ..Choice::default() };
        };
        let is_other = |pair: &Commanded| {
            pair.response != first.response
                && pair.command != first.command
                && pair.likeness <= Likeness::Suffix
        };
        let other_pairs = others.iter().filter(|pair| is_other(pair)).copied().collect();
        let is_pair = matches!(first.likeness, Likeness::Whole | Likeness::Suffix);
        Choice {
            input: Some(first.command),
            output: Some(first.response),
            is_pair,
            is_weak: first.likeness == Likeness::Plain,
            other_pairs: if input.is_none() && output.is_none() { other_pairs } else { Vec::new() },
            unlike: None,
        }
    }

    /// What moves by a command, called as it is but for such a word: `throttle_cmd` and `throttle_pos`. A position comes before a speed.
    fn answer_of(&self, command: usize) -> Option<usize> {
        let base = guess::without(self.column(command), Part::Command)?;
        let moved = |part: Part| {
            let is =
                |k: &usize| *k != command && guess::without(self.column(*k), part).as_ref() == Some(&base);
            only(self.signals.iter().copied().filter(is))
        };
        moved(Part::Motion).or_else(|| moved(Part::Answer))
    }

    /// The signals, or the one that the user named.
    fn signals_and(&self, given: Option<usize>) -> Vec<usize> {
        given.map_or_else(|| self.signals.to_vec(), |given| vec![given])
    }

    /// The column whose name says most surely that it is one of these parts, the first of several; the first part named counts most.
    ///
    /// Words that all signals share say nothing, a command is no output, and a signal in its unit is better than the same one in volts.
    pub(super) fn called(&self, parts: &[Part], taken: Option<usize>) -> Option<usize> {
        let forms = self.signals.iter().map(|k| guess::plain_form(self.column(*k)));
        let converted: HashSet<Vec<String>> =
            forms.filter(|(_, is_raw)| !is_raw).map(|(name, _)| name).collect();
        let is_raw = |k: usize| {
            let (name, is_raw) = guess::plain_form(self.column(k));
            is_raw && converted.contains(&name)
        };
        let shared = self.shared_words();
        let is_out = parts.contains(&Part::Output);
        let of = |k: usize, part: Part| {
            let says_nothing = || self.is_shared(k, part, &shared);
            let is_command = is_out
                && guess::surety(self.column(k), Part::Command).is_some()
                && !self.is_shared(k, Part::Command, &shared)
                || is_out && guess::is_of_controller(self.column(k));
            let surety = guess::surety(self.column(k), part).filter(|_| !is_command && !says_nothing())?;
            Some((surety, !is_raw(k), std::cmp::Reverse(k)))
        };
        let free = || self.signals.iter().copied().filter(|k| Some(*k) != taken);
        let of_part = |part: &Part| free().filter_map(|k| of(k, *part)).max();
        // The whole name of any part counts more than a word.
        let found: Vec<_> = parts.iter().filter_map(of_part).collect();
        let named = found.iter().find(|(surety, ..)| *surety == Surety::Name);
        named.or(found.first()).map(|(.., k)| k.0)
    }

    /// The words that stand in the names of all signals.
    fn shared_words(&self) -> BTreeSet<String> {
        let mut names = self.signals.iter().map(|k| guess::named(self.column(*k)));
        let mut shared: BTreeSet<String> = names.next().unwrap_or_default().into_iter().collect();
        for name in names {
            if shared.is_empty() {
                break;
            }
            shared.retain(|word| name.contains(word));
        }
        shared
    }

    /// Whether the words by which a column would be this part stand in the names of all signals.
    fn is_shared(&self, k: usize, part: Part, shared: &BTreeSet<String>) -> bool {
        let name = guess::named(self.column(k));
        let Some(others) = guess::without(self.column(k), part) else { return false };
        let mut deciding = name.iter().filter(|word| !others.contains(word));
        self.signals.len() > 1 && deciding.all(|word| shared.contains(word))
    }

    /// By what a column is named on the command line.
    pub(super) fn name(&self, k: usize) -> String {
        match self.table.has_header && self.is_unique(k) {
            true => self.column(k).name.clone(),
            false => (k + 1).to_string(),
        }
    }

    /// What messages call a column.
    pub(super) fn shown(&self, k: usize) -> String {
        match self.table.has_header && self.is_unique(k) {
            true => format!("`{}`", self.column(k).label()),
            false => format!("column {}", k + 1),
        }
    }

    /// Names and units do not say which columns are meant.
    pub(super) fn ambiguous(&self, input: Option<usize>, output: Option<usize>) -> DataProblem {
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

    pub(super) fn share_a_name(&self, a: usize, b: usize) -> bool {
        let name = |k: usize| simplified(&self.column(k).name);
        self.table.has_header && name(a) == name(b)
    }

    fn is_unique(&self, k: usize) -> bool {
        let name = &self.column(k).name;
        !name.is_empty() && self.table.columns.iter().filter(|column| column.name == *name).count() == 1
    }
}

/// The only one of some columns.
pub(super) fn only(mut columns: impl Iterator<Item = usize>) -> Option<usize> {
    columns.next().filter(|_| columns.next().is_none())
}
