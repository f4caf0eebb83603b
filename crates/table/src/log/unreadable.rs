//! A file that is no log that can be read.

use crate::table::{DataError, DataProblem, TableError};
use std::path::Path;

pub(super) fn log(path: &Path, reason: String) -> TableError {
    let path = path.display().to_string();
    TableError::Data(DataError { path, place: None, problem: DataProblem::NotLog { reason } })
}
