//! The blind study: rigs are made and their keys sealed, a diagnosis sees the rigs alone, and only then are keys opened.
//!
//! ```text
//! scenario → design → seal (make, hash the keys) → examine (diagnose, open, compare) → score → report
//! ```
//!
//! The diagnosis is an argument: a function from a rig and settings. It gets a [`Rig`](switchback_model::rig::Rig) rebuilt from its recipe, which
//! holds what a user's folder holds and nothing else. The key file is on disk, and its SHA-256 in the report, before the
//! first diagnosis. Nothing depends on the number of threads.

mod case;
mod confounded_effects;
mod design;
mod examination;
mod examine;
mod judged;
mod place;
mod report;
mod scenario;
mod score;
mod seal;

pub use case::Case;
pub(crate) use confounded_effects::same_class;
pub use design::Kind;
pub use design::Ticket;
pub use design::design;
pub use examination::Blind;
pub use examine::Examiner;
pub use examine::examine;
pub use place::PlaceCheck;
pub use report::artefacts;
pub use report::json;
pub(crate) use report::summary;
pub use scenario::Expect;
pub use scenario::Study;
pub use scenario::is_blind;
pub use scenario::read;
pub use score::AbstentionRow;
pub use score::AccuracyRow;
pub use score::BaselineRow;
pub use score::ClosureRow;
pub use score::Confusion;
pub use score::PlaceRow;
pub use score::Scores;
pub use score::SizeRow;
pub use score::score;
pub use seal::Sealed;
pub use seal::WrittenKeys;
pub use seal::seal;
