//! Writing and printing results: all of a command's files appear, or none does.

mod artefacts;
mod columns;
mod error;
mod folder;
mod page;
mod schema;
mod sha256;
mod single;
mod staging;
mod written;

pub use artefacts::Artefacts;
pub use columns::columns;
pub use error::OutputError;
pub use folder::OutputFolder;
pub use page::print;
pub use schema::stamped;
pub use sha256::sha256;
pub use single::OutputFile;
pub(crate) use staging::abandon;
