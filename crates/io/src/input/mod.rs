//! Reading what users write: measurements in any dialect, text files, and TOML whose errors point into the file.

mod closest;
mod file_error;
pub mod gzip;
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
pub use file_error::FileError;
pub use kinds::FileKind;
pub use table::Cells;
pub(crate) use table::Column;
pub use table::DataError;
pub use table::DataProblem;
pub(crate) use table::Kind;
pub(crate) use table::Place;
pub use table::Step;
pub(crate) use table::Table;
pub(crate) use table::TableError;
pub(crate) use table::unit;
pub use text_file::read_text;
pub use toml_file::TomlError;
pub use toml_file::TomlFile;
pub use two_numbers::TwoNumbers;
