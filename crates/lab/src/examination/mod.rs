//! What sealed examinations have in common: keys are written before the first diagnosis, parts run apart and are put together, an
//! interrupted one goes on where it stood, and a report says what must be reached and what was.
//!
//! ```text
//! scenario → design → seal (make, hash the keys) → judge (diagnose, open, compare) → report
//! ```
//!
//! [`Examination`] is what one of them must show; the command line runs any of them.

mod calibration;
pub mod field;
mod json;
pub mod laboratory;
mod measure;
mod part;
mod random;
mod reply;
mod scenario;
mod tables;

pub use calibration::CalibrationBin;
pub(crate) use calibration::calibration_bins;
pub(crate) use calibration::calibration_error;
pub use json::BinFile;
pub use json::MeasureFile;
pub use json::ShareFile;
pub use measure::Bound;
pub(crate) use measure::Line;
pub use measure::Measure;
pub use measure::Share;
pub(crate) use measure::bounded;
pub(crate) use measure::measures_table;
pub use part::Label;
pub use part::Part;
pub use part::Whole;
pub use part::case_lines;
pub use part::merged;
pub use part::read_cases;
pub use random::scramble;
pub(crate) use random::uniform;
pub use reply::ClosureCheck;
pub use reply::Evidence;
pub use reply::PairEvidence;
pub use reply::Reply;
pub(crate) use scenario::ScenarioError;
pub(crate) use scenario::effects_listed;
pub(crate) use scenario::refuse_large_design;
pub(crate) use scenario::refuse_more_than;
pub(crate) use scenario::study_of;
pub use tables::csv;
pub(crate) use tables::share_field;

use serde::{Deserialize, Serialize};
use std::fmt;
use switchback_io::output::Artefacts;

/// The key file of a report folder.
pub const KEY_FILE: &str = "key.jsonl";

/// Hears of each piece of work that is done.
pub(crate) type Done<'a> = &'a (dyn Fn() + Sync);

/// A rig of the design with its key closed.
pub trait Sealed: Send + Sync {
    /// Its number in the full design.
    fn id(&self) -> usize;

    /// Its line in the key file: whatever makes one rig another.
    fn key_line(&self) -> String;
}

/// A rig after its key was opened: all that a report is made of.
///
/// Read back only from a text that is never let go: its names may be slices of it.
pub trait Judged: Clone + Send + Sync + Serialize + Deserialize<'static> {
    /// Its number in the full design.
    fn id(&self) -> usize;

    /// The table of answers.
    fn answers(cases: &[Self]) -> String;
}

/// A report, and whether it is what the scenario expects.
#[derive(Debug, Clone)]
pub struct Report {
    /// All its files but the key.
    pub files: Artefacts,
    /// What is printed.
    pub summary: String,
    /// Whether every expectation of the scenario is met.
    pub is_as_expected: bool,
}

/// Not all rigs of an examination.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Partial {
    /// Rigs that were judged.
    pub rigs: usize,
    /// … of so many.
    pub of: usize,
}

impl fmt::Display for Partial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PARTIAL: the examination was stopped after {} of {} rigs.", self.rigs, self.of)
    }
}

impl Report {
    /// The same report where not all rigs are judged: each of its texts says so, and so does results.json.
    #[must_use]
    pub fn of_part(self, partial: Partial) -> Self {
        let mut files = Artefacts::default();
        for (name, contents) in self.files.iter() {
            match name.rsplit_once('.') {
                Some((_, "json")) => files.add(name, with_partial(contents, partial)),
                Some((_, "txt" | "md")) => {
                    files.add(name, format!("{partial}\n\n{}", String::from_utf8_lossy(contents)));
                }
                // A page is drawn of the other files.
                Some((_, "html")) => {}
                _ => files.add(name, contents),
            }
        }
        Self { files, summary: format!("{partial}\n\n{}", self.summary), ..self }
    }
}

/// A JSON object with the field `partial`.
fn with_partial(object: &[u8], partial: Partial) -> String {
    let mut value: serde_json::Value = serde_json::from_slice(object).expect("the program wrote it");
    value["partial"] = serde_json::to_value(partial).expect("numbers are JSON");
    format!("{value:#}\n")
}

/// One kind of examination, ready to run. Nothing that it gives depends on the number of threads.
pub trait Examination: Sync {
    /// A rig to be made.
    type Ticket: Send;
    /// A rig that was made.
    type Sealed: Sealed;
    /// A rig that was judged.
    type Case: Judged;
    /// The figures of merit of all cases.
    type Scores;

    /// The files of a report.
    const FILES: &'static [&'static str];

    /// Seconds of one thread that a rig takes, made and judged, in the mean.
    const SECONDS: f64;

    /// The scenario's name: that of the report's folder.
    fn name(&self) -> &str;

    /// What it is to answer.
    fn question(&self) -> &str;

    /// Rigs to be made, in random order.
    ///
    /// # Errors
    /// A design that cannot be made.
    fn design(&self) -> miette::Result<Vec<Self::Ticket>>;

    /// Makes rigs in parallel and keeps their keys; `before` is the text of a key file that the same program wrote, or empty.
    ///
    /// # Errors
    /// A rig that cannot be made.
    fn seal(
        &self,
        tickets: Vec<Self::Ticket>,
        before: &str,
        done: Done<'_>,
    ) -> miette::Result<Vec<Self::Sealed>>;

    /// Diagnoses a rig, then opens its key.
    ///
    /// # Errors
    /// A rig that cannot be made again.
    fn judge(&self, rig: &Self::Sealed) -> miette::Result<Self::Case>;

    /// Scores the cases.
    fn score(&self, cases: &[Self::Case]) -> Self::Scores;

    /// The report without its figures.
    ///
    /// # Errors
    /// A table that cannot be written.
    fn report(&self, key_sha256: &str, cases: &[Self::Case], scores: &Self::Scores)
    -> miette::Result<Report>;
}

/// The key file: one JSON object a line and a rig, in the order of the design.
pub fn key_file<S: Sealed>(sealed: &[S]) -> String {
    let mut all: Vec<&S> = sealed.iter().collect();
    all.sort_by_key(|one| one.id());
    all.into_iter().fold(String::new(), |text, one| text + &one.key_line() + "\n")
}
