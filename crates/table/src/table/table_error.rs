//! Why a file gives no table at all.

use super::error::DataError;
use crate::FileError;

/// Why a file gives no table at all.
#[derive(Debug)]
pub enum TableError {
    /// The file cannot be read.
    File(FileError),
    /// The file holds no table of numbers.
    Data(DataError),
}
