//! A sealed examination of the diagnosis: keys are written before the first diagnosis, parts run apart and are put together, an interrupted
//! one goes on where it stood, and a report says what must be reached and what was.
//!
//! ```text
//! scenario → tickets → seal (make, hash the keys) → judge (diagnose, open, compare) → score → report
//! ```
//!
//! It has two designs, [`Design::Laboratory`] and [`Design::Field`]: which rigs are made, how one is opened and diagnosed, what is scored and what
//! must be reached. Everything else is common. The key file is on disk, and its SHA-256 in the report, before the first diagnosis.

mod answers;
mod calibration;
mod case;
mod confusion;
mod design;
mod examiner;
mod fault;
pub(crate) mod field;
mod how;
mod laboratory;
mod measure;
mod part;
mod place_check;
mod random;
mod rating;
mod reply;
mod report;
mod results;
mod run;
mod scenario;
mod scores;
mod sealed;
mod share;
mod table;
#[cfg(test)]
mod tests;
mod ticket;
mod wanted;

pub use answers::answers;
pub use calibration::CalibrationBin;
pub use case::Answered;
pub use case::Case;
pub use confusion::Confusion;
pub use design::Design;
pub use design::Kind;
pub use examiner::Examiner;
pub use field::Bases;
pub use field::measured_rigs;
pub use measure::Bound;
pub use measure::Expect;
pub use measure::Measure;
pub use part::Label;
pub use part::Part;
pub use part::Whole;
pub use part::merged;
pub use random::scramble;
pub(crate) use random::uniform;
pub(crate) use rating::WIDEST_CLASS;
pub use reply::ClosureCheck;
pub use reply::Evidence;
pub use reply::Reply;
pub use report::Report;
pub use results::Partial;
pub use results::Refused;
pub use results::Results;
pub use run::Examination;
pub use scenario::Study;
pub use scenario::design_of;
pub use scenario::read;
pub use scores::Scores;
pub use sealed::KEY_FILE;
pub use sealed::Sealed;
pub use sealed::key_file;
pub use share::Share;
pub use table::Cell;
pub use table::Row;
pub use table::Table;
pub use table::csv;
pub use ticket::Ticket;
pub(crate) use ticket::law;
