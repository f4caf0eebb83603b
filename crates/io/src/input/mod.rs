//! Reading what users write: text files, JSON, and TOML whose errors point into the file.

pub mod gzip;
pub mod json_file;
mod kinds;
pub mod nullable;
mod terms;
mod toml_file;
mod two_numbers;

pub use kinds::FileKind;
pub use switchback_table::FileError;
pub use switchback_table::TextKind;
pub use switchback_table::closest;
pub use switchback_table::door::{names, own, program, read_within, regular};
pub use switchback_table::read_text;
pub use switchback_table::stream;
pub use switchback_table::table::Cells;
pub use switchback_table::table::DataError;
pub use switchback_table::table::DataProblem;
pub use switchback_table::table::Step;
pub use toml_file::TomlError;
pub use toml_file::TomlFile;
pub use two_numbers::TwoNumbers;
