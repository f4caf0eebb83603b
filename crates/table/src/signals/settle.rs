//! Which of the columns offered are input and output: names say it and the data agree, or the data say it and that is a doubt.

use super::causality::Precedence;
use super::guess::{self, Part, Quantity};
use super::offer::{Choice, Offer, only};
use super::relations::{Pair, Relations};
use crate::table::DataProblem;

/// Input and output.
#[derive(Debug)]
pub(super) struct Settled {
    pub(super) input: usize,
    pub(super) output: Option<usize>,
    /// Why they may be others, or the other way round.
    pub(super) doubt: Option<String>,
    /// Columns that move with them.
    pub(super) others: Vec<usize>,
}

/// Columns that a sentence names, at most.
const NAMED: usize = 4;

/// Input and output, each as given or else inferred.
///
/// # Errors
/// What cannot be inferred.
pub(super) fn settle(
    offer: &Offer<'_>,
    given: (Option<usize>, Option<usize>),
    needs_output: bool,
) -> Result<Settled, DataProblem> {
    let is_guessed = given.0.is_none() || given.1.is_none();
    let mut choice = offer.by_names(given.0, given.1);
    let shares = |choice: &Choice| matches!((choice.input, choice.output), (Some(input), Some(output)) if is_guessed && offer.share_a_name(input, output));
    if given == (None, None) && shares(&choice) {
        choice = Choice::default();
    }
    let settlement = Settlement { offer, given };
    if needs_output && is_guessed {
        if let (Some(input), Some(output)) = (choice.input, choice.output) {
            if !shares(&choice) {
                return settlement.checked(&choice, input, output);
            }
        } else if let Some(found) = settlement.by_data(&choice) {
            return Ok(found);
        }
    }
    let mut input = choice.input;
    if !needs_output && input.is_none() {
        input = offer.called(&[Part::Motion], None).or_else(|| only(offer.signals.iter().copied()));
    }
    match (input, choice.output) {
        // Two columns of one name are distinguished by number only.
        _ if shares(&Choice { input, ..choice.clone() }) => Err(offer.ambiguous(None, None)),
        (Some(input), output) if output.is_some() || !needs_output => {
            Ok(Settled { input, output, doubt: None, others: Vec::new() })
        }
        (Some(input), None) if offer.signals == [input] => {
            Err(DataProblem::NotMeasured { input: offer.column(input).label() })
        }
        (input, output) => Err(offer.ambiguous(input, output)),
    }
}

struct Settlement<'a> {
    offer: &'a Offer<'a>,
    given: (Option<usize>, Option<usize>),
}

impl Settlement<'_> {
    fn relations(&self) -> Option<Relations> {
        let named = [self.given.0, self.given.1].into_iter().flatten();
        let all: Vec<usize> = named.chain(self.offer.signals.iter().copied()).collect();
        Relations::of(self.offer.table, &all)
    }

    /// What the data say of a pair chosen by names: nothing at all connects it while others are connected, or the output comes first.
    fn checked(&self, choice: &Choice, input: usize, output: usize) -> Result<Settled, DataProblem> {
        let plain =
            |doubt: Option<String>| Settled { input, output: Some(output), doubt, others: Vec::new() };
        let several = (!choice.other_pairs.is_empty()).then(|| self.of_several(choice, input, output));
        let signals = self.offer.signals.len() + usize::from(self.given != (None, None));
        if signals <= 2 && !choice.is_weak {
            return Ok(plain(several));
        }
        let Some(relations) = self.relations() else { return Ok(plain(several)) };
        let offer = self.offer;
        let [a, b] = [input, output].map(|k| offer.shown(k));
        let refuted = relations.refutes(input, output);
        if refuted && choice.is_pair {
            return Ok(plain(Some(format!(
                "{a} and {b} are called a command and its response, but neither says anything of the other here, as other columns do; if others are meant, {}",
                self.unnamed()
            ))));
        }
        if refuted {
            let other =
                self.by_relations(&relations).filter(|pair| (pair.input, pair.output) != (input, output));
            let Some(pair) = other else { return Err(offer.ambiguous(self.given.0, self.given.1)) };
            let [c, d] = [pair.input, pair.output].map(|k| offer.shown(k));
            let why = format!(
                "{a} and {b} are called an input and an output, but neither says anything of the other here: {c} and {d} are taken, since the past of {c} improves the prediction of {d}"
            );
            let remedy =
                offer.input_form.naming(&[("input", offer.name(input)), ("output", offer.name(output))]);
            let doubt = Some(format!("{why}; if that is wrong, {remedy}"));
            return Ok(Settled { input: pair.input, output: Some(pair.output), doubt, others: pair.others });
        }
        let others =
            relations.moving_together().into_iter().filter(|k| *k != input && *k != output).collect();
        let doubt = if choice.is_pair {
            self.of_test(&relations, input, output)
        } else {
            self.of_names(choice, &relations, [input, output])
        };
        Ok(Settled { others, ..plain(several.or(doubt)) })
    }

    /// What may be meant instead of a pair that names say and the data do not refute.
    fn of_names(
        &self,
        choice: &Choice,
        relations: &Relations,
        [input, output]: [usize; 2],
    ) -> Option<String> {
        let offer = self.offer;
        let [a, b] = [input, output].map(|k| offer.shown(k));
        let naming = |input: usize, output: usize| {
            offer.input_form.naming(&[("input", offer.name(input)), ("output", offer.name(output))])
        };
        if relations.is_backward(input, output) {
            return Some(format!(
                "{a} is taken for the input and {b} for the output by their names and units, but the past of {b} predicts {a} and not the other way round; if {b} is the input, {}",
                naming(output, input)
            ));
        }
        let other = offer.other_input(input).filter(|_| self.given.0.is_none());
        if let Some(other) = other {
            let c = offer.shown(other);
            return Some(format!(
                "{a} is taken for the input, but {c} is called one too; if that is meant, {}",
                naming(other, output)
            ));
        }
        if let Some(unlike) = choice.unlike.filter(|k| relations.are_connected(input, *k)) {
            let (kind, c) = (guess::quantity(offer.column(input)).name(), offer.shown(unlike));
            return Some(format!(
                "{b} is taken for the output, as a {kind} like {a}, but {c} is called a response and follows too; if that is meant, {}",
                naming(input, unlike)
            ));
        }
        let is_effort = guess::quantity(offer.column(output)) == Quantity::Effort;
        let places = match self.given.1.is_none() && is_effort && offer.drives(input) {
            true => relations.places_behind(offer.table, input, output),
            false => Vec::new(),
        };
        let first = *places.first()?;
        let verb = if places.len() == 1 { "follows" } else { "follow" };
        let named = listed(places.iter().map(|k| offer.shown(*k)).collect());
        Some(format!(
            "{b} is taken for the output, but {named} {verb} {a} too; if that is meant, {}",
            naming(input, first)
        ))
    }

    /// The force that a specimen answers with, where a testing machine's own travel follows its command.
    fn of_test(&self, relations: &Relations, input: usize, output: usize) -> Option<String> {
        let offer = self.offer;
        let is_tested = guess::is_of_testing_machine(offer.column(input)) && self.given == (None, None);
        let follows = |k: usize| [input, output].into_iter().any(|from| relations.are_connected(from, k));
        let is_force = |k: &usize| guess::is_force(offer.column(*k)) && follows(*k);
        let others = offer.signals.iter().copied().filter(|k| *k != input && *k != output);
        let force = others.filter(|_| is_tested).find(is_force)?;
        let [a, b, c] = [input, output, force].map(|k| offer.shown(k));
        let naming = offer.input_form.naming(&[("input", offer.name(output)), ("output", offer.name(force))]);
        Some(format!(
            "{b} is taken for the output, as the response to {a}, but {c} follows too; if the specimen is meant, rather than the drive, {naming}"
        ))
    }

    /// Several commands have a response each.
    fn of_several(&self, choice: &Choice, input: usize, output: usize) -> String {
        let pairs: Vec<String> = choice
            .other_pairs
            .iter()
            .map(|pair| {
                format!("{} with {}", self.offer.shown(pair.command), self.offer.shown(pair.response))
            })
            .collect();
        let [a, b] = [input, output].map(|k| self.offer.shown(k));
        let first = &choice.other_pairs[0];
        let [command, response] = [first.command, first.response].map(|k| self.offer.name(k));
        format!(
            "several commands have a response: {a} with {b} is taken, but there {} also {}; if another is meant, {}",
            if pairs.len() == 1 { "is" } else { "are" },
            listed(pairs),
            self.offer.input_form.naming(&[("input", command), ("output", response)])
        )
    }

    /// What the data say where names do not, in doubt.
    fn by_data(&self, choice: &Choice) -> Option<Settled> {
        let offer = self.offer;
        let in_doubt = |pair: Pair, doubt: String| Settled {
            input: pair.input,
            output: Some(pair.output),
            doubt: Some(doubt),
            others: pair.others,
        };
        if let ((None, None), [first, second]) = ((choice.input, choice.output), offer.signals) {
            return self.of_two(*first, *second);
        }
        let relations = self.relations()?;
        let [input, output] = [choice.input, choice.output];
        let found = match (input, output) {
            (Some(input), None) => relations.output_of(offer.table, input),
            (None, Some(output)) => relations.input_of(output),
            _ => relations.pair(offer.table),
        };
        // A command by its name alone that nothing follows is not the one that was played.
        let found = found.or_else(|| self.by_relations(&relations))?;
        let [a, b] = [found.input, found.output].map(|k| offer.shown(k));
        let doubt = match (input, output) {
            (Some(known), None) if known == found.input => format!(
                "no name says which column is the output: {b} is taken for the output, since the past of {a} improves its prediction{}",
                self.beside(&found)
            ),
            (None, Some(known)) if known == found.output => format!(
                "no name says which column is the input: {a} is taken for the input, since its past predicts {b} better than the other way round{}",
                self.beside(&found)
            ),
            _ => return Some(in_doubt(found.clone(), self.no_name(&found))),
        };
        let remedy = self.unnamed();
        Some(in_doubt(found, format!("{doubt}; if that is wrong, {remedy}")))
    }

    /// What the data say, with what the user named.
    fn by_relations(&self, relations: &Relations) -> Option<Pair> {
        match self.given {
            (Some(input), _) => relations.output_of(self.offer.table, input),
            (_, Some(output)) => relations.input_of(output),
            _ => relations.pair(self.offer.table),
        }
    }

    /// Both directions, tried: the input is the one whose past says what the other does next. The order in the file decides where neither does.
    fn of_two(&self, first: usize, second: usize) -> Option<Settled> {
        let offer = self.offer;
        let rows: Vec<usize> = (0..offer.table.places.len())
            .filter(|&row| [first, second].iter().all(|k| offer.column(*k).values[row].is_finite()))
            .collect();
        let of = |k: usize| -> Vec<f64> { rows.iter().map(|&row| offer.column(k).values[row]).collect() };
        let precedence = Precedence::of(&of(first), &of(second));
        if precedence.is_none() && offer.table.has_header {
            return None;
        }
        let (input, output) = match precedence {
            Some(precedence) if !precedence.is_forward() => (second, first),
            _ => (first, second),
        };
        let doubt = match precedence {
            Some(_) => self.no_name(&Pair { input, output, others: Vec::new() }),
            None => format!(
                "no name says which column is the input: {} is taken for the input, as the first; if that is wrong, {}",
                offer.shown(input),
                offer.input_form.naming(&[("input", offer.name(output)), ("output", offer.name(input))])
            ),
        };
        Some(Settled { input, output: Some(output), doubt: Some(doubt), others: Vec::new() })
    }

    fn no_name(&self, pair: &Pair) -> String {
        let offer = self.offer;
        let [a, b] = [pair.input, pair.output].map(|k| offer.shown(k));
        let remedy = match pair.others.is_empty() {
            true => offer
                .input_form
                .naming(&[("input", offer.name(pair.output)), ("output", offer.name(pair.input))]),
            false => self.unnamed(),
        };
        format!(
            "no name says which column is the input: {a} is taken for the input, since its past predicts {b} better than the other way round{}; if that is wrong, {remedy}",
            self.beside(pair)
        )
    }

    /// Signals that take part too.
    fn beside(&self, pair: &Pair) -> String {
        let others: Vec<String> = pair.others.iter().map(|k| self.offer.shown(*k)).collect();
        match others.len() {
            0 => String::new(),
            1 => format!(" ({} moves with them)", others[0]),
            _ => format!(" ({} move with them)", listed(others)),
        }
    }

    /// What to write, with names left open but those that the user gave.
    fn unnamed(&self) -> String {
        let name = |known: Option<usize>| known.map_or_else(|| "NAME".to_owned(), |k| self.offer.name(k));
        self.offer.input_form.naming(&[("input", name(self.given.0)), ("output", name(self.given.1))])
    }
}

/// `a, b and c`, and how many more there are.
fn listed(mut names: Vec<String>) -> String {
    if names.len() > NAMED {
        let more = names.len() - NAMED;
        names.truncate(NAMED);
        names.push(format!("{more} more"));
    }
    let last = names.pop().unwrap_or_default();
    if names.is_empty() { last } else { format!("{} and {last}", names.join(", ")) }
}
