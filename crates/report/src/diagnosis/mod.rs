//! A diagnosis as one JSON object, in words, and as the files of its report.

mod artefacts;
mod differences;
pub mod json;
mod place;
pub(crate) mod posterior;
mod probability;
mod sentences;
mod shift;
mod stability;
mod why;
mod words;

pub use artefacts::artefacts;
pub(crate) use differences::Difference;
pub use json::json;
pub use json::schema;
pub(crate) use place::SIGNIFICANT;
pub(crate) use probability::probability;
pub use why::why;
pub use words::verdict;
pub use words::words;
