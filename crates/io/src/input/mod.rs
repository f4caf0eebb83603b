//! Reading what users write: measurements in any dialect, text files, and TOML whose errors point into the file.

mod closest;
pub mod json_file;
mod kinds;
mod mat;
pub mod nullable;
pub mod stream;
mod table;
mod terms;
mod text_file;
mod text_pieces;
mod toml_file;
mod two_numbers;

pub use closest::closest;
pub use kinds::FileKind;
pub use table::{Cells, DataError, DataProblem, Place, Step};
pub use table::{Column, Kind, Table, TableError, unit};
pub use text_file::{FileError, read_text};
pub use toml_file::{TomlError, TomlFile};
pub use two_numbers::TwoNumbers;
