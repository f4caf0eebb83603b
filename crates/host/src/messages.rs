//! What the processes of an FMU say to each other: lines of JSON, read within bounds.

use crate::map::Map;
use serde::{Deserialize, Serialize};
use std::io::{BufRead, Read};

/// What is to be run: the only line that the simulation reads.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Job {
    pub(crate) map: Map,
    /// Quantity and unit of the records' input and output.
    pub(crate) labels: [String; 2],
    pub(crate) sample_time: f64,
    /// The input of each record.
    pub(crate) inputs: Vec<Vec<f64>>,
}

/// A line that the simulation writes.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Line {
    /// So many bytes are unpacked.
    Unpacked(u64),
    /// It stands at a sample of a record.
    At(usize, usize),
    /// The outputs of a record.
    Ran(usize, Vec<f64>),
    /// The FMU cannot be run: the reason and the remedy.
    Refused(String, String),
    /// The FMU cannot go on.
    Failed(String),
}

/// What was said in all.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct End {
    /// The outputs of the records that were run, in their order.
    pub runs: Vec<Vec<f64>>,
    /// The record and sample that it stood at last.
    pub at: Option<(usize, usize)>,
    /// The reason why it went no further, and a remedy where there is one.
    pub why: Option<(String, Option<String>)>,
}

/// Most bytes of a number in JSON, with its comma: `-2.2250738585072014e-308,`.
const NUMBER: usize = 26;

/// Most bytes of a line beside its numbers.
const WORDS: usize = 1 << 16;

/// Listens to a simulation of records of these lengths, until it ends or says what no simulation says; `goes_on` is called whenever it has come
/// further. No more is kept than one line and the outputs of the records.
pub fn heard(lengths: &[usize], source: impl BufRead, mut goes_on: impl FnMut()) -> End {
    let most = WORDS + NUMBER * lengths.iter().max().unwrap_or(&0);
    let (mut end, mut unpacked, mut line, mut source) = (End::default(), 0, Vec::new(), source);
    loop {
        line.clear();
        let read = source.by_ref().take(most as u64).read_until(b'\n', &mut line);
        // A process that was ended may have left half a line.
        if read.is_err() || line.pop() != Some(b'\n') {
            return end;
        }
        let Some(is_further) =
            serde_json::from_slice(&line).ok().and_then(|line| end.take(line, lengths, &mut unpacked))
        else {
            end.why = Some(("its process says what none of ours does".to_owned(), None));
            return end;
        };
        if is_further {
            goes_on();
        }
        if end.why.is_some() {
            return end;
        }
    }
}

impl End {
    /// Whether a line leads further; none where it has no place here.
    fn take(&mut self, line: Line, lengths: &[usize], unpacked: &mut u64) -> Option<bool> {
        match line {
            Line::Unpacked(bytes) => Some(std::mem::replace(unpacked, bytes.max(*unpacked)) < bytes),
            Line::At(record, sample) => {
                let is_further = self.at.is_none_or(|at| at < (record, sample));
                self.at = self.at.max(Some((record, sample)));
                Some(is_further)
            }
            Line::Ran(record, y) => {
                let is_next = record == self.runs.len() && lengths.get(record) == Some(&y.len());
                (is_next && y.iter().all(|y| y.is_finite())).then(|| self.runs.push(y))?;
                Some(true)
            }
            Line::Refused(what, remedy) => {
                self.why = Some((what, Some(remedy)));
                Some(true)
            }
            Line::Failed(what) => {
                self.why = Some((what, None));
                Some(true)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn all(text: &str) -> (End, usize) {
        let mut steps = 0;
        (heard(&[2, 1], text.as_bytes(), || steps += 1), steps)
    }

    #[test]
    fn outputs_are_taken_in_the_order_of_their_records() {
        let (end, steps) = all(
            "{\"unpacked\":9}\n{\"at\":[0,0]}\n{\"ran\":[0,[1.0,-2.5]]}\n{\"at\":[1,0]}\n{\"ran\":[1,[3.0]]}\n",
        );
        assert_eq!(
            (end.runs, end.at, end.why, steps),
            (vec![vec![1.0, -2.5], vec![3.0]], Some((1, 0)), None, 5)
        );
    }

    #[test]
    fn a_place_that_does_not_change_is_no_sign_of_life() {
        let (end, steps) =
            all("{\"at\":[1,5]}\n{\"at\":[1,5]}\n{\"at\":[0,9]}\n{\"unpacked\":0}\n{\"at\":[1,");
        assert_eq!((end.at, steps), (Some((1, 5)), 1));
    }

    #[test]
    fn what_has_no_place_ends_the_conversation() {
        let long = "x".repeat(WORDS + 2 * NUMBER);
        for text in [
            "nonsense\n",
            "{\"ran\":[1,[3.0]]}\n",
            "{\"ran\":[0,[3.0]]}\n",
            "{\"ran\":[0,[1e999,0.0]]}\n",
            "{\"ran\":[0,[null,0.0]]}\n",
            "\n",
            "{\"at\":[-1,0]}\n",
        ] {
            let (end, _) = all(&(text.to_owned() + "{\"at\":[0,0]}\n"));
            assert!(end.why.is_some() && end.at.is_none() && end.runs.is_empty(), "{text}");
        }
        // A line that never ends is not kept.
        assert_eq!(all(&(long + "\n{\"at\":[0,0]}\n")).0, End::default());
        let (end, _) = all("{\"refused\":[\"a\",\"b\"]}\n{\"failed\":\"c\"}\n");
        assert_eq!(end.why, Some(("a".to_owned(), Some("b".to_owned()))));
    }

    proptest! {
        #[test]
        fn numbers_come_back_to_the_bit(y in prop::collection::vec(prop::num::f64::NORMAL, 1..50)) {
            let text = serde_json::to_string(&Line::Ran(0, y.clone())).expect("numbers are JSON") + "\n";
            prop_assert!(text.len() <= WORDS + NUMBER * y.len());
            prop_assert_eq!(heard(&[y.len()], text.as_bytes(), || ()).runs, vec![y]);
        }

        #[test]
        fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = heard(&[3], bytes.as_slice(), || ());
        }
    }
}
