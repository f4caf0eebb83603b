//! Writing and printing results: all of a command's files appear, or none does.

mod artefacts;
mod columns;
mod error;
mod folder;
mod foreign;
mod page;
mod schema;
mod sha256;
mod single;
mod staging;
mod visible;
mod written;

pub use artefacts::Artefacts;
pub use columns::columns;
pub use error::OutputError;
pub use folder::OutputFolder;
pub use foreign::{csv_cell, markdown, markdown_code, markdown_text};
pub use page::{note, print};
pub use schema::stamped;
pub use sha256::sha256;
pub use single::OutputFile;
pub(crate) use staging::abandon;
pub use visible::visible;
