//! The messages of a log, as columns.

use super::cdr;
use super::definition::{Definition, LONGEST_NAME};
use super::unreadable;
use crate::contained::contained;
use crate::door::{Opened, open};
use crate::table::{Column, Kind, Place, Table, TableError, empty_column};
use mcap::io::MessageReader;
use mcap::sans_io::LinearReaderOptions;
use mcap::{Channel, Message};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::BufReader;
use std::path::Path;

/// What a clock in the header of a message is called, and what its columns are not.
const STAMP: [&str; 2] = ["header.stamp.sec", "header.stamp.nanosec"];
const NANOSECONDS: i128 = 1_000_000_000;

/// Topics that are named in a note.
const SHOWN: usize = 8;

/// Most columns of a log.
const MOST_COLUMNS: usize = 1 << 16;

/// Numbers that take as much memory as the clock of a message does, which is kept as text, too.
const CLOCK: usize = 10;

/// How much of a log is read.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Most messages.
    pub(super) messages: usize,
    /// Most numbers of the table that comes of it.
    pub(super) numbers: usize,
}

/// The numbers of a topic, message by message.
#[derive(Default)]
struct Topic {
    /// Nanoseconds of each message.
    instants: Vec<i128>,
    /// Values by their paths, NaN where a message has none.
    values: BTreeMap<String, Vec<f64>>,
}

/// What was read of a log.
#[derive(Default)]
pub(super) struct Messages {
    topics: BTreeMap<String, Topic>,
    /// Topics whose messages cannot be read.
    left: BTreeSet<String>,
    count: usize,
    /// Columns of all topics.
    width: usize,
    /// Messages of the topic that has most.
    longest: usize,
    /// Whether more of them came than the limits allow.
    pub(super) is_cut: bool,
    /// Why no more messages came, where that is not the end of the log.
    broken: Option<String>,
}

/// Reads the first messages of a log, of all topics or the columns named.
///
/// # Errors
/// A file that cannot be opened, or is broken before its first message.
pub(super) fn collect(
    path: &Path,
    names: Option<&[String; 2]>,
    limits: Limits,
) -> Result<Messages, TableError> {
    let mut reader = reader(open(path).map_err(TableError::File)?);
    let mut definitions: HashMap<u16, Option<Definition>> = HashMap::new();
    let mut found = Messages::default();
    while let Some(message) = next(&mut reader) {
        let message = match message {
            Ok(message) => message,
            Err(reason) => {
                found.broken = Some(reason);
                break;
            }
        };
        found.count += 1;
        let channel = &message.channel;
        if names.is_none_or(|names| names.iter().any(|name| is_of(name, &channel.topic))) {
            let definition = definitions.entry(channel.id).or_insert_with(|| definition(channel));
            found.add(&message, definition.as_ref(), names);
        }
        found.is_cut = found.numbers() >= limits.numbers;
        if found.is_cut || found.count >= limits.messages {
            return Ok(found);
        }
    }
    match &found.broken {
        Some(reason) if found.topics.is_empty() => Err(unreadable::log(path, reason.clone())),
        _ if found.topics.is_empty() => {
            Err(unreadable::log(path, "it holds no message of ROS 2 with numbers in it".to_owned()))
        }
        _ => Ok(found),
    }
}

type Reader = MessageReader<BufReader<Opened>>;

/// A reader of a log, which refuses records that are much longer than the file: their length is taken on trust else, and so much memory with it.
fn reader(file: Opened) -> Reader {
    /// A compressed record is so many times as long as the file, at most.
    const RATIO: u64 = 64;
    /// Bytes of a record that any file may have: a picture of four million points in one colour.
    const ANY: u64 = 1 << 25;
    /// Most bytes of a record.
    const LONGEST: u64 = 1 << 28;
    let length = file.metadata().map_or(0, |metadata| metadata.len());
    let longest = length.saturating_mul(RATIO).clamp(ANY, LONGEST);
    let options = LinearReaderOptions::default().with_record_length_limit(longest as usize);
    MessageReader::new_with_options(BufReader::new(file), options)
}

/// The next message, or why none comes. Of a chunk that contradicts itself the library may give up by a panic.
fn next(reader: &mut Reader) -> Option<Result<Message<'static>, String>> {
    match contained(|| reader.next()) {
        Some(message) => message.map(|message| message.map_err(|error| error.to_string())),
        None => Some(Err("its parts contradict each other".to_owned())),
    }
}

/// Whether a column is one of a topic.
fn is_of(name: &str, topic: &str) -> bool {
    name.strip_prefix(topic).is_some_and(|rest| rest.starts_with('.'))
}

fn definition(channel: &Channel<'_>) -> Option<Definition> {
    let schema = channel.schema.as_ref()?;
    let is_ros = channel.message_encoding == "cdr" && schema.encoding == "ros2msg";
    let is_named = channel.topic.len() <= LONGEST_NAME;
    Definition::parse(std::str::from_utf8(&schema.data).ok()?).filter(|_| is_ros && is_named)
}

impl Messages {
    fn add(&mut self, message: &Message<'_>, definition: Option<&Definition>, names: Option<&[String; 2]>) {
        let topic = &message.channel.topic;
        let mut values: Vec<(String, f64)> = Vec::new();
        let mut stamp = [0.0; 2];
        let is_wanted = |path: &str| {
            names.is_none_or(|names| {
                names.iter().any(|name| is_of(name, topic) && name[topic.len() + 1..] == *path)
            })
        };
        let read = definition.and_then(|definition| {
            cdr::visit(definition, &message.data, &mut |path, value| match STAMP
                .iter()
                .position(|part| *part == path)
            {
                Some(part) => stamp[part] = value,
                None if is_wanted(path) && values.len() <= MOST_COLUMNS => {
                    values.push((path.to_owned(), value));
                }
                None => {}
            })
        });
        let is_new = |path: &str| self.topics.get(topic).is_none_or(|of| !of.values.contains_key(path));
        let is_full = self.width >= MOST_COLUMNS && values.iter().any(|(path, _)| is_new(path));
        if read.is_none() || values.len() > MOST_COLUMNS || is_full {
            self.left.insert(topic.chars().take(LONGEST_NAME).collect());
            return;
        }
        let [seconds, nanoseconds] = stamp.map(|part| i128::from(part as i64));
        let own = seconds * NANOSECONDS + nanoseconds;
        let of = self.topics.entry(topic.clone()).or_default();
        let row = of.instants.len();
        of.instants.push(if own == 0 { i128::from(message.log_time) } else { own });
        self.longest = self.longest.max(row + 1);
        let width = of.values.len();
        for (path, value) in values {
            let column = of.values.entry(path).or_default();
            column.resize(row, f64::NAN);
            column.push(if value.is_finite() { value } else { f64::NAN });
        }
        self.width += of.values.len() - width;
    }

    /// How many numbers the table of them has, or as many as take the memory that it takes: all its columns are as long as the longest.
    fn numbers(&self) -> usize {
        (self.width + CLOCK * self.topics.len()).saturating_mul(self.longest)
    }

    /// Every topic's clock and numbers as columns; rows are messages, each topic's counted by itself.
    pub(super) fn table(&self, path: &Path) -> Table {
        let with_numbers = || self.topics.iter().filter(|(_, topic)| !topic.values.is_empty());
        let rows =
            with_numbers().map(|(_, topic)| topic).map(|topic| topic.instants.len()).max().unwrap_or(0);
        let mut notes = vec![format!("MCAP, {} messages", self.count)];
        if let Some(reason) = &self.broken {
            notes.push(format!("broken after them ({reason}): what precedes is used"));
        }
        if !self.left.is_empty() {
            let shown: Vec<&str> = self.left.iter().take(SHOWN).map(String::as_str).collect();
            let more = if self.left.len() > SHOWN { ", …" } else { "" };
            notes.push(format!("topics whose messages cannot be read left out: {}{more}", shown.join(", ")));
        }
        Table {
            path: path.display().to_string(),
            columns: with_numbers().flat_map(|(name, topic)| topic.columns(name, rows)).collect(),
            places: (1..=rows as u64).map(Place::Row).collect(),
            has_header: true,
            notes,
            ..Table::default()
        }
    }
}

impl Topic {
    /// In the order of their instants, which messages may arrive out of.
    fn columns(&self, name: &str, rows: usize) -> Vec<Column> {
        let mut order: Vec<usize> = (0..self.instants.len()).collect();
        order.sort_by_key(|k| self.instants[*k]);
        let origin = order.first().map_or(0, |k| self.instants[*k]);
        let since = |k: &usize| (self.instants[*k] - origin) as f64 / NANOSECONDS as f64;
        let written = |k: &usize| {
            let (seconds, rest) =
                (self.instants[*k].div_euclid(NANOSECONDS), self.instants[*k].rem_euclid(NANOSECONDS));
            format!("{seconds}.{rest:09}")
        };
        let filled = |values: Vec<f64>| {
            let mut values = values;
            values.resize(rows, f64::NAN);
            values
        };
        let clock = Column {
            kind: Kind::Stamp,
            origin,
            values: filled(order.iter().map(since).collect()),
            stamps: order.iter().map(written).collect(),
            ..empty_column(format!("{name} time"), None)
        };
        let numbers = self.values.iter().map(|(path, values)| Column {
            values: filled(order.iter().map(|k| values.get(*k).copied().unwrap_or(f64::NAN)).collect()),
            ..empty_column(format!("{name}.{path}"), None)
        });
        std::iter::once(clock).chain(numbers).collect()
    }
}
