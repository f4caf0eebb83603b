//! Writing and printing results: all of a command's files appear, or none does.

mod artefacts;
mod columns;
mod folder;
mod page;
mod schema;
mod staging;

pub use artefacts::Artefacts;
pub use columns::columns;
pub use folder::{OutputError, OutputFolder};
pub use page::print;
pub use schema::stamped;
