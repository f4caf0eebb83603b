//! Reading what users write: measurements in any dialect, text files, and TOML whose errors point into the file.

mod closest;
pub(crate) mod json_file;
mod kinds;
mod mat;
pub(crate) mod nullable;
pub(crate) mod stream;
mod table;
mod terms;
mod text_file;
mod text_pieces;
mod toml_file;
mod two_numbers;

pub(crate) use closest::closest;
pub(crate) use kinds::FileKind;
pub use table::{Cells, DataError, DataProblem, Place, Step};
pub(crate) use table::{Column, Kind, Table, TableError, unit};
pub use text_file::{FileError, read_text};
pub use toml_file::{TomlError, TomlFile};
pub use two_numbers::TwoNumbers;
