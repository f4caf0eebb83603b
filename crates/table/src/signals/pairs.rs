//! A command and its response, which are called alike but for that word: `target pos (5)` and `pos (5)`.

use super::guess::{Quantity, quantity};
use super::spelling::{last_part, simplified};
use super::words::{self, Words};
use crate::table::Table;
use std::collections::{BTreeSet, HashMap};

/// Signals whose names share all words that tell signals apart: more than that share none that does.
const MOST_ALIKE: usize = 64;

/// How much two names say that they belong together, the most first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Likeness {
    /// They differ by words for a command and a response only.
    Whole,
    /// So do the last parts of their paths.
    Last,
    /// `q_d` beside `q`.
    Suffix,
    /// `Position` beside `ActualPosition`.
    Plain,
}

/// A command and what responds to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Commanded {
    pub(super) command: usize,
    pub(super) response: usize,
    pub(super) likeness: Likeness,
}

/// The words of a column's name.
struct Name {
    column: usize,
    whole: Vec<String>,
    last: Vec<String>,
    quantity: Quantity,
}

impl Name {
    fn of(table: &Table, column: usize) -> Self {
        let name = &table.columns[column].name;
        let words = |name: &str| simplified(name).split(' ').map(str::to_owned).collect();
        let quantity = quantity(&table.columns[column]);
        Self { column, whole: words(name), last: words(last_part(name)), quantity }
    }

    /// Whether a word of it is one of a list.
    fn has(&self, list: Words) -> bool {
        self.whole.iter().chain(&self.last).any(|word| words::has(list, word))
    }

    /// Words for where a machine should be say more than those for what moves it.
    fn is_reference(&self) -> bool {
        self.whole.iter().any(|word| words::has(words::REFERENCE, word))
    }
}

/// The commands among some columns with their responses among others, the likeliest first: places before speeds, these before forces and
/// currents.
pub(super) fn pairs(table: &Table, commands: &[usize], responses: &[usize]) -> Vec<Commanded> {
    let names = |columns: &[usize]| columns.iter().map(|k| Name::of(table, *k)).collect::<Vec<_>>();
    let (commands, responses) = (names(commands), names(responses));
    let known = Known::of(&responses);
    let mut found: Vec<(bool, Quantity, bool, usize, Commanded)> = Vec::new();
    for (order, command) in commands.iter().enumerate() {
        let fitting = known.beside(command).into_iter().map(|k| &responses[k]);
        let fitting = fitting.filter(|response| response.column != command.column);
        let ranked = fitting.filter_map(|response| {
            let likeness = likeness(command, response, table)?;
            let shared = command.whole.iter().filter(|word| response.whole.contains(word)).count();
            Some(((likeness, std::cmp::Reverse(shared)), response))
        });
        if let Some(((likeness, _), response)) = ranked.min_by_key(|(rank, _)| *rank) {
            let pair = Commanded { command: command.column, response: response.column, likeness };
            let quantity = command.quantity.min(response.quantity);
            found.push((likeness == Likeness::Plain, quantity, !command.is_reference(), order, pair));
        }
    }
    found.sort_by_key(|(is_plain, quantity, is_effort, order, _)| (*is_plain, *quantity, *is_effort, *order));
    found.into_iter().map(|(.., pair)| pair).collect()
}

/// Responses by the words that tell signals apart, so that not every command is compared with every signal.
struct Known {
    /// By whole names, and by the last parts of their paths.
    alike: [HashMap<Vec<String>, Vec<usize>>; 2],
    /// Those with a word by which the same name without it is the command.
    actual: BTreeSet<usize>,
}

impl Known {
    fn of(responses: &[Name]) -> Self {
        let mut alike = [HashMap::new(), HashMap::new()];
        for (k, response) in responses.iter().enumerate() {
            for (alike, name) in alike.iter_mut().zip([&response.whole, &response.last]) {
                alike.entry(telling(name)).or_insert_with(Vec::new).push(k);
            }
        }
        let is_actual = |k: &usize| responses[*k].has(words::ACTUAL);
        Self { alike, actual: (0..responses.len()).filter(is_actual).collect() }
    }

    /// Those that can be the response of a command, in their order.
    fn beside(&self, command: &Name) -> Vec<usize> {
        let [whole, last] = [telling(&command.whole), telling(&command.last)];
        let is_command = command.has(words::COMMAND);
        let of = |alike: &HashMap<Vec<String>, Vec<usize>>, name: &Vec<String>| {
            let found = alike.get(name).map_or(&[][..], Vec::as_slice);
            if found.len() > MOST_ALIKE { Vec::new() } else { found.to_vec() }
        };
        let mut found: Vec<usize> = of(&self.alike[0], &whole);
        found.retain(|k| is_command || self.actual.contains(k));
        if is_command {
            found.extend(of(&self.alike[1], &last));
        }
        if command.whole.iter().any(|word| word == "d") {
            let without: Vec<String> = whole.into_iter().filter(|word| word != "d").collect();
            found.extend(of(&self.alike[0], &without));
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// The words of a name in which a command and its response do not differ.
fn telling(name: &[String]) -> Vec<String> {
    const PARTS: [Words; 5] =
        [words::COMMAND, words::RESPONSE, words::ACTUAL, words::NEUTRAL, words::CONTROLLER];
    let distinguishes = |word: &&String| !PARTS.iter().any(|list| words::has(list, word));
    name.iter().filter(distinguishes).collect::<BTreeSet<_>>().into_iter().cloned().collect()
}

fn likeness(command: &Name, response: &Name, table: &Table) -> Option<Likeness> {
    let all_of = |rest: &[&String], lists: &[Words]| {
        rest.iter().all(|word| lists.iter().any(|list| words::has(list, word)))
    };
    let has = |rest: &[&String], list: Words| rest.iter().any(|word| words::has(list, word));
    let is_pair = |command: &[String], response: &[String]| {
        let (asked, found) = (apart_from(command, response), apart_from(response, command));
        has(&asked, words::COMMAND)
            && all_of(&asked, &[words::COMMAND, words::NEUTRAL, words::CONTROLLER])
            && all_of(&found, &[words::RESPONSE, words::NEUTRAL])
    };
    if is_pair(&command.whole, &response.whole) {
        return Some(Likeness::Whole);
    }
    let (asked, found) =
        (apart_from(&command.whole, &response.whole), apart_from(&response.whole, &command.whole));
    let is_numbered =
        |rest: &[&String]| rest.iter().any(|word| word.ends_with(|end: char| end.is_ascii_digit()));
    let has_path = command.last.len() < command.whole.len() && response.last.len() < response.whole.len();
    let is_of_one = has_path && !is_numbered(&asked) && !is_numbered(&found);
    let is_named = |last: &[String]| !last.iter().all(|word| words::has(words::COMMAND, word));
    if is_of_one && is_named(&command.last) && is_pair(&command.last, &response.last) {
        return Some(Likeness::Last);
    }
    let goes_with = || correlation(table, command.column, response.column) > 0.5;
    if found.is_empty() && matches!(asked[..], [word] if word == "d") && goes_with() {
        return Some(Likeness::Suffix);
    }
    let is_actual = has(&found, words::ACTUAL) && all_of(&found, &[words::ACTUAL, words::NEUTRAL]);
    (asked.is_empty() && is_actual && goes_with()).then_some(Likeness::Plain)
}

/// The words of a name that are not in the other.
fn apart_from<'n>(name: &'n [String], other: &[String]) -> Vec<&'n String> {
    name.iter().filter(|word| !other.contains(word)).collect()
}

/// The correlation of two columns: a signal has none with its derivative.
fn correlation(table: &Table, a: usize, b: usize) -> f64 {
    /// Rows between which others are left out.
    const LOOKED_AT: usize = 10_000;
    let (a, b) = (&table.columns[a].values, &table.columns[b].values);
    let every = (a.len() / LOOKED_AT).max(1);
    let rows = (0..a.len()).step_by(every).filter(|row| a[*row].is_finite() && b[*row].is_finite());
    let pairs: Vec<(f64, f64)> = rows.map(|row| (a[row], b[row])).collect();
    let count = pairs.len().max(1) as f64;
    let mean = pairs.iter().fold((0.0, 0.0), |sum, (a, b)| (sum.0 + a / count, sum.1 + b / count));
    let of = |product: fn(f64, f64) -> f64| {
        pairs.iter().map(|(a, b)| product(a - mean.0, b - mean.1)).sum::<f64>()
    };
    of(|a, b| a * b) / (of(|a, _| a * a) * of(|_, b| b * b)).sqrt().max(f64::MIN_POSITIVE)
}
