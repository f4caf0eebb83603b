//! Writing results: all of a command's files appear, or none does.

mod artefacts;
mod folder;
mod staging;

pub use artefacts::Artefacts;
pub use folder::{OutputError, OutputFolder};
