//! Which effects would have been found in a rig's own records, and from which size on.
//!
//! ```text
//! records → ground → diagnoses without fault → rounds (size, law, noise → machine → diagnose → posterior) → findings
//! ```
//!
//! A draw takes the records as a model would have them, its simulation plus the residuals drawn anew in blocks, so that noise stays what it is
//! and no cause is left in it; puts in a fault of the effect by one of the maker's laws, half of the time the plain one, with parameters and noise of
//! its own; and diagnoses that with the settings that the rig would be diagnosed with. The model is the one given, which is then also the one
//! diagnosed ("what has changed?"), else that identified from the fit records. The size of a fault is the maker's: root mean square of what
//! survives identification anew over what the model leaves on held-out records without the fault.
//!
//! A fault is *found* where its effect is named, or stands in a class or a shortlist of at most three. Sizes are chosen by a [`Staircase`], one an
//! effect. All effects have a draw in each round; one that is settled leaves its draws to the others. A budget counts draws, never time: findings
//! depend on records, options and seed alone.

mod answer;
mod context;
mod error;
mod finding;
mod json;
mod plan;
mod psychometric;
mod request;
mod search;
mod staircase;
mod study;
mod table;
mod words;

pub(crate) use answer::Answer;
pub use context::Context;
pub use context::Draw;
pub use error::PowerError;
#[cfg(test)]
pub(crate) use finding::Answers;
pub use finding::Finding;
pub use finding::Outcome;
pub use json::json;
pub use json::schema;
pub use plan::Plan;
pub(crate) use psychometric::Psychometric;
pub use request::Request;
pub(crate) use search::Search;
pub(crate) use staircase::Conclusion;
pub use staircase::LARGEST;
pub(crate) use staircase::SHARE;
pub(crate) use staircase::SIZES;
pub(crate) use staircase::Staircase;
pub use study::Power;
pub use study::measure;
pub use table::csv;
pub use words::words;

#[cfg(test)]
mod tests;
