//! Tables in Apache Parquet, as data frames and the episodes of LeRobot are stored: every number is a column, those of a list are called
//! `action[2]`. Whatever else is in the file, pictures and words, is not read.

use self::magic::MAGIC;
use crate::table::{DataError, DataProblem, TableError};
use std::path::Path;

#[cfg(feature = "parquet")]
mod compact;
mod magic;
#[cfg(feature = "parquet")]
mod rows;
#[cfg(feature = "parquet")]
mod stated;
#[cfg(all(test, feature = "parquet"))]
mod tests;

/// Whether a file is one: by its ending, or its first bytes.
pub(crate) fn is_parquet(path: &Path, bytes: &[u8]) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("parquet")) || bytes.starts_with(MAGIC)
}

fn unreadable(path: &Path, reason: String) -> TableError {
    let path = path.display().to_string();
    TableError::Data(DataError { path, place: None, problem: DataProblem::NotParquet { reason } })
}

#[cfg(not(feature = "parquet"))]
pub(crate) fn read(path: &Path) -> Result<crate::table::Table, TableError> {
    Err(unreadable(path, "this program was built without the feature `parquet`".to_owned()))
}

/// Its numbers.
///
/// # Errors
/// A file that is none, is cut off, or holds no numbers.
#[cfg(feature = "parquet")]
pub(crate) fn read(path: &Path) -> Result<crate::table::Table, TableError> {
    use crate::contained::contained;
    use crate::door::open;
    let file = open(path).map_err(TableError::File)?;
    // Of a file that contradicts itself the library may give up by a panic.
    let read = contained(|| rows::collect(file));
    let rows = read.unwrap_or_else(|| Err("its parts contradict each other".to_owned()));
    rows.and_then(|rows| rows.table(path)).map_err(|reason| unreadable(path, reason))
}
