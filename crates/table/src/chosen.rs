//! What is taken of a log, which holds more signals than are kept in memory at once.

use crate::table::{Table, TableError};
use std::path::Path;

/// Which columns of a log's first rows are input and output; none where that is in doubt.
pub(crate) type Choice<'a> = &'a mut dyn FnMut(&Table) -> Option<Chosen>;

/// Reads the columns chosen of a log, with their clocks.
pub(crate) type LogReader = fn(&Path, Choice<'_>) -> Result<Table, TableError>;

/// Input and output, and others that they could be.
#[cfg_attr(not(any(feature = "mcap", feature = "mdf")), allow(dead_code, reason = "no log is read"))]
pub(crate) struct Chosen {
    pub(crate) signals: [usize; 2],
    /// A time column that the user named.
    #[cfg_attr(
        not(feature = "mdf"),
        allow(dead_code, reason = "only logs in MDF 4 have signals that are times")
    )]
    pub(crate) time: Option<usize>,
    pub(crate) rivals: Vec<usize>,
}
