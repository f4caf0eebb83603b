//! Reading what users write: text files, and TOML whose errors point into the file.

mod closest;
mod text_file;
mod toml_file;

pub(crate) use closest::closest;
pub use text_file::{FileError, read_text};
pub use toml_file::{TomlError, TomlFile};
