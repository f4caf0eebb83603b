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
mod design;
mod examination;
mod examine;
mod place;
mod report;
mod scenario;
mod score;
mod seal;
mod twins;

pub use case::{Baseline, Case};
pub use design::{Kind, Ticket, design};
pub use examination::Blind;
pub use examine::{Examiner, examine};
pub use place::PlaceCheck;
pub use report::json;
pub use report::{artefacts, summary};
pub use scenario::{Expect, Study, is_blind, read};
pub use score::{
    AbstentionRow, AccuracyRow, BaselineRow, Calibration, ClosureRow, Confusion, PlaceRow, Scores, SizeRow,
    TARGETS, score,
};
pub use seal::{Sealed, WrittenKeys, seal};
pub use twins::{class_of, same_class};
