//! The field examination: known faults in measured records and in made ones as the field has them.
//!
//! ```text
//! scenario → bases → design → seal (machine, hash the keys) → judge (diagnose twice, open, compare) → score → report
//! ```
//!
//! A *base* is a measured rig from a folder, or a made one. Every rig of the design is a base with a fault, a foreign fault, resampled
//! residuals, or nothing; it is diagnosed twice, once with the base's own model given ("what has changed?") and once without. What a measured
//! base shows by itself is unlabelled: an answer is judged by what it names beyond the base's own verdict, so that silence is silence and
//! nothing that the machine has anyway counts as an error.

mod bases;
mod case;
mod design;
mod examination;
mod fault;
mod judged;
mod made;
mod report;
mod resample;
mod scenario;
mod score;
mod seal;
mod wanted;

pub use bases::Base;
pub use bases::Bases;
pub use case::Answered;
pub use case::Case;
pub use case::Fault;
pub use design::Kind;
pub use design::Ticket;
pub use design::design;
pub(crate) use design::law;
pub use examination::Examiner;
pub use examination::Field;
pub use report::json;
pub(crate) use resample::resampled;
pub(crate) use resample::runs_of;
pub use scenario::Expect;
pub use scenario::is_field;
pub use scenario::read;
pub use score::AnswerRow;
pub(crate) use score::BaseVerdicts;
pub(crate) use score::Rating;
pub use score::Scores;
pub(crate) use score::WIDEST_CLASS;
pub use score::score;
pub use seal::How;
pub use seal::Sealed;
