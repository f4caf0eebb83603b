//! MATLAB files, where the program is built to read them.

use super::table::{DataError, DataProblem, Table, TableError};
use std::path::Path;

pub(super) fn read(path: &Path) -> Result<Table, TableError> {
    Err(TableError::Data(DataError {
        path: path.display().to_string(),
        place: None,
        problem: DataProblem::NotMatlab {
            reason: "this program was built without the feature `matlab`".to_owned(),
        },
    }))
}
