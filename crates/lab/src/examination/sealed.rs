//! Rigs with their keys closed, and the key file.

use super::field;
use super::laboratory;
use super::ticket::Ticket;
use crate::generate;
use std::collections::HashMap;

/// The key file of a report folder.
pub const KEY_FILE: &str = "key.jsonl";

/// What is withheld about a rig.
#[derive(Debug, Clone)]
pub(crate) enum Key {
    /// All that the maker of the rig knows.
    Laboratory(Box<generate::Key>),
    /// What was put into a base.
    Field(field::Key),
}

/// A rig of the design with its key closed.
#[derive(Debug, Clone)]
pub struct Sealed {
    pub(crate) ticket: Ticket,
    pub(crate) key: Key,
}

impl Sealed {
    /// Which rig of the design.
    pub fn ticket(&self) -> &Ticket {
        &self.ticket
    }

    /// Its line in the key file: whatever makes one rig another.
    pub fn key_line(&self) -> String {
        match &self.key {
            Key::Laboratory(key) => laboratory::key_line(&self.ticket, key),
            Key::Field(key) => serde_json::to_string(key).expect("numbers and strings are JSON"),
        }
    }
}

/// The key file: one JSON object a line and a rig, in the order of the design.
pub fn key_file(sealed: &[Sealed]) -> String {
    let mut all: Vec<&Sealed> = sealed.iter().collect();
    all.sort_by_key(|one| one.ticket.id);
    all.into_iter().fold(String::new(), |text, one| text + &one.key_line() + "\n")
}

/// The number of the rig of a line of a key file.
pub(crate) fn id_of(line: &str) -> Option<usize> {
    let value: serde_json::Value = serde_json::from_str(line).ok()?;
    value["id"].as_u64().map(|id| id as usize)
}

/// The lines of a key file that the same program wrote, by the number of the rig: what they show need not be searched for again.
#[derive(Debug, Default)]
pub(crate) struct WrittenKeys<'t>(HashMap<usize, &'t str>);

impl<'t> WrittenKeys<'t> {
    /// Reads a key file; lines that are no keys are none.
    pub(crate) fn read(text: &'t str) -> Self {
        Self(text.lines().filter_map(|line| Some((id_of(line)?, line))).collect())
    }

    /// The line of a ticket.
    pub(crate) fn of(&self, ticket: &Ticket) -> Option<&'t str> {
        self.0.get(&ticket.id).copied()
    }
}
