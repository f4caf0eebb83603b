//! Why a file gives no table at all.

use super::error::DataError;
use crate::input::FileError;

/// Why a file gives no table at all.
#[derive(Debug)]
pub(crate) enum TableError {
    /// The file cannot be read.
    File(FileError),
    /// The file holds no table of numbers.
    Data(DataError),
}
