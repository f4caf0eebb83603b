//! One process of a method of others, and what it answers.

use super::design::Design;
use super::estimator::{Estimates, Records, checked};
use super::protocol::{Answer, Greeting, PROTOCOL, Stored, common, line};
use std::collections::VecDeque;
use std::time::{Duration, Instant};
use switchback_host::{Heard, Worker};

/// Most bytes of an answer beside its numbers.
const WORDS: usize = 1 << 16;

/// Most bytes of a number, its comma included.
const NUMBER: usize = 26;

/// More parameters than any request asks for: a thousand points on each border, twenty coefficients of each kind.
const PARAMETERS: usize = 2048;

/// Longest text that is quoted of what a process says.
const QUOTED: usize = 200;

/// A process that can be asked.
#[derive(Debug)]
pub(super) struct Conversation {
    worker: Worker,
    patience: Duration,
    /// The next request's.
    id: u64,
    /// The cell whose inputs stand at the beginning of the block: all that its requests have in common, and where its outputs begin.
    cell: Option<(usize, String, usize)>,
}

/// A process that cannot be asked any more: how it ended, and what it said last.
#[derive(Debug)]
pub(super) struct Broken(pub(super) String);

/// Requests that wait for an answer, in their order: the place of the records, and whether it has failed already.
struct Open<'a> {
    first: u64,
    places: VecDeque<usize>,
    results: &'a mut [Option<Result<Estimates, String>>],
}

impl Conversation {
    /// Begins a process and greets it; its version is in what it answers.
    pub(super) fn begin(command: &[String], patience: Duration) -> Result<(Self, String), Broken> {
        let refused = |error: std::io::Error| Broken(format!("no process could be begun: {error}"));
        let worker = Worker::begin(command, WORDS + 2 * NUMBER * PARAMETERS).map_err(refused)?;
        let greeting =
            Greeting { schema: PROTOCOL.to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() };
        let text = serde_json::to_string(&greeting).expect("words are JSON") + "\n";
        let _where_it_has_ended = worker.send(&text);
        let new = Self { worker, patience, id: 0, cell: None };
        match new.worker.hear(patience) {
            Heard::Line(line) => match serde_json::from_slice::<Greeting>(&line) {
                Ok(greeting) if greeting.schema == PROTOCOL => Ok((new, greeting.version)),
                _ => Err(new.break_off(format!("it began with `{}` instead of a greeting", quoted(&line)))),
            },
            Heard::Nothing => {
                Err(new.break_off(format!("it gave no greeting within {} s", patience.as_secs_f64())))
            }
            Heard::End => Err(new.ended("before its greeting")),
        }
    }

    /// Has it estimate from those records of a design that have no result. All of them have one in the end; or else it broke at one, which has
    /// failed, and nothing is known of those behind.
    pub(super) fn ask(
        mut self,
        design: &Design,
        records: &[Records<'_>],
        results: &mut [Option<Result<Estimates, String>>],
    ) -> Option<Self> {
        let places: VecDeque<usize> = (0..records.len()).filter(|&place| results[place].is_none()).collect();
        let mut open = Open { first: self.id, places, results };
        let mut lines = String::new();
        if let Err(error) = self.write(design, records, &open.places, &mut lines) {
            open.fail(|| format!("its block cannot be written: {error}"));
            self.end();
            return None;
        }
        let _where_it_has_ended = self.worker.send(&lines);
        let mut since = Instant::now();
        while !open.places.is_empty() {
            match self.worker.hear(self.patience.saturating_sub(since.elapsed())) {
                Heard::Line(line) => match Answer::read(&line).filter(|answer| open.awaits(answer.id)) {
                    Some(answer) => {
                        open.take(design, answer);
                        since = Instant::now();
                    }
                    None => open.fail(|| format!("it printed `{}`, which is no answer", quoted(&line))),
                },
                Heard::Nothing => {
                    open.fail(|| format!("no answer within {} s", self.patience.as_secs_f64()));
                    self.end();
                    return None;
                }
                Heard::End => {
                    let Broken(why) = self.ended("before its answer");
                    open.fail(|| why);
                    return None;
                }
            }
        }
        Some(self)
    }

    /// Writes inputs and outputs into the block, and the lines that speak of them.
    fn write(
        &mut self,
        design: &Design,
        records: &[Records<'_>],
        places: &VecDeque<usize>,
        lines: &mut String,
    ) -> std::io::Result<()> {
        if self.cell.as_ref().is_none_or(|(cell, ..)| *cell != design.cell) {
            let [first, second] = design.experiments.each_ref().map(|e| e.v.as_slice());
            let v = [Stored { at: 0, count: first.len() }, Stored { at: first.len(), count: second.len() }];
            self.worker.write(0, &bytes([first, second].into_iter()))?;
            let block = self.worker.block().display().to_string();
            self.cell = Some((design.cell, common(design, &block, v), first.len() + second.len()));
        }
        let Some((_, common, begin)) = &self.cell else { return Ok(()) };
        let mut at = *begin;
        let outputs = places.iter().flat_map(|&place| records[place].y);
        self.worker.write((8 * at) as u64, &bytes(outputs))?;
        for &place in places {
            let Records { replicate, antithetic, y } = records[place];
            let stored = y.map(|y| {
                let stored = Stored { at, count: y.len() };
                at += y.len();
                stored
            });
            lines.push_str(&line(self.id, replicate, antithetic, stored, common));
            self.id += 1;
        }
        Ok(())
    }

    /// Ends it.
    pub(super) fn end(self) {
        let _however_it_ends = self.worker.end();
    }

    /// Ends it for a reason.
    fn break_off(self, why: String) -> Broken {
        self.end();
        Broken(why)
    }

    /// After it ended by itself.
    fn ended(self, when: &str) -> Broken {
        match self.worker.end() {
            Ok((how, printed)) => Broken(format!("it ended {when} ({how}){}", last_words(&printed))),
            Err(error) => Broken(format!("it ended {when}: {error}")),
        }
    }
}

impl Open<'_> {
    /// Whether this is the id of a request without an answer.
    fn awaits(&self, id: u64) -> bool {
        id.checked_sub(self.first).is_some_and(|k| (k as usize) < self.places.len())
    }

    /// Takes an answer: those before it, which were passed over, have failed.
    fn take(&mut self, design: &Design, answer: Answer) {
        while self.first < answer.id {
            self.fail(|| "it answered the next request instead".to_owned());
            self.next();
        }
        let result = match answer {
            Answer { failed: Some(why), .. } => Err(one_line(&why)),
            Answer { estimate: Some(estimate), se, .. } => checked(design, &estimate, se.as_deref()),
            Answer { .. } => Err("its answer has neither `estimate` nor `failed`".to_owned()),
        };
        if let Some(place) = self.places.front() {
            self.results[*place].get_or_insert(result);
        }
        self.next();
    }

    fn next(&mut self) {
        self.places.pop_front();
        self.first += 1;
    }

    /// The first one fails, unless it has already.
    fn fail(&mut self, why: impl FnOnce() -> String) {
        if let Some(place) = self.places.front() {
            self.results[*place].get_or_insert_with(|| Err(why()));
        }
    }
}

/// Numbers as they stand in the block.
fn bytes<'a>(runs: impl Iterator<Item = &'a [f64]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    for run in runs {
        let begin = bytes.len();
        bytes.resize(begin + size_of_val(run), 0);
        let places = bytes[begin..].chunks_exact_mut(size_of::<f64>());
        places.zip(run).for_each(|(place, x)| place.copy_from_slice(&x.to_le_bytes()));
    }
    bytes
}

/// The beginning of a line, in letters that can be shown.
fn quoted(line: &[u8]) -> String {
    one_line(&String::from_utf8_lossy(line))
}

/// A text on one line, and not too long.
fn one_line(text: &str) -> String {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut shown: String = words.chars().filter(|c| !c.is_control()).take(QUOTED).collect();
    if words.chars().count() > QUOTED {
        shown.push('…');
    }
    shown
}

/// The last line of what it printed to standard error.
fn last_words(printed: &str) -> String {
    let last = printed.lines().rfind(|line| !line.trim().is_empty());
    last.map_or_else(String::new, |line| format!("; it said: {}", one_line(line)))
}
