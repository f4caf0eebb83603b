//! Logs of robots in the format MCAP: topics, each with messages at instants of its own.
//!
//! Every number of a message is a column, called `/topic.field[2]`; every topic has a clock, of its headers where they hold stamps, else of the
//! logger. Messages are described by the definitions of ROS 2 in the log itself.

use crate::chosen::Choice;
use crate::table::{Table, TableError};
use std::io;
use std::path::Path;

#[cfg(feature = "mcap")]
mod cdr;
#[cfg(feature = "mcap")]
mod definition;
#[cfg(feature = "mcap")]
mod messages;
#[cfg(all(test, feature = "mcap"))]
mod tests;
mod topic;
mod unreadable;
#[cfg(feature = "mcap")]
mod write;

pub use topic::{LogField, LogTopic};

/// How a log begins.
const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Whether a file is such a log: by its ending, or its first bytes.
pub(crate) fn is_log(path: &Path, bytes: &[u8]) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap")) || bytes.starts_with(MAGIC)
}

#[cfg(not(feature = "mcap"))]
pub(crate) fn read(path: &Path, _choice: Choice<'_>) -> Result<Table, TableError> {
    Err(unreadable::log(path, "this program was built without the feature `mcap`".to_owned()))
}

/// The columns chosen, with their clocks; those of the first messages where nothing can be chosen. Rows of other topics are no samples of these, and
/// their clocks no clocks.
///
/// # Errors
/// A file that is no such log, or holds no message that can be read.
#[cfg(feature = "mcap")]
pub(crate) fn read(path: &Path, choice: Choice<'_>) -> Result<Table, TableError> {
    use crate::chosen::Chosen;
    use messages::Limits;
    /// Messages looked at to see what there is, and their numbers: 512 MiB.
    const FIRST: Limits = Limits { messages: 20_000, numbers: 1 << 26 };
    /// Most numbers of a table, which is kept whole: 2 GiB.
    const MOST: Limits = Limits { messages: usize::MAX, numbers: 1 << 28 };
    let head = messages::collect(path, None, FIRST)?;
    let table = head.table(path);
    match choice(&table) {
        None => Ok(table),
        Some(Chosen { signals, rivals, .. }) => {
            let name = |k: usize| table.columns[k].name.clone();
            let names = signals.map(name);
            let whole = messages::collect(path, Some(&names), MOST)?;
            if whole.is_cut {
                return Err(unreadable::log(path, format!("it holds more than {} numbers", MOST.numbers)));
            }
            let mut whole = whole.table(path);
            if !rivals.is_empty() {
                let rivals: Vec<String> = rivals.into_iter().map(|k| format!("`{}`", name(k))).collect();
                whole.notes.push(format!("the log also holds {}", rivals.join(", ")));
            }
            Ok(whole)
        }
    }
}

/// Whether this program was built to write logs.
pub const WRITES_LOGS: bool = cfg!(feature = "mcap");

/// The bytes of an MCAP log whose messages are described as those of ROS 2.
///
/// # Errors
/// Where the program was built without the feature `mcap`.
pub fn log_bytes(topics: &[LogTopic]) -> io::Result<Vec<u8>> {
    #[cfg(feature = "mcap")]
    return write::bytes(topics).map_err(io::Error::other);
    #[cfg(not(feature = "mcap"))]
    {
        let _unwritten = topics;
        Err(io::Error::new(io::ErrorKind::Unsupported, "this program was built without the feature `mcap`"))
    }
}
