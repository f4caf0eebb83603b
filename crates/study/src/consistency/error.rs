//! Why a study cannot be run.

use thiserror::Error;

/// Why a study cannot be run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A method has no limit on some cell: its information matrix is singular even with endless data.
    #[error(
        "{method} cannot be run on case `{case}`, border `{border}`, m = {points}: {source}; drop the method, or change the case"
    )]
    NoLimit {
        /// Name of the method.
        method: &'static str,
        /// Name of the case.
        case: String,
        /// Name of the border.
        border: String,
        /// Points `m`.
        points: usize,
        /// What the method says.
        source: switchback_identify::pulse::PulseFitError,
    },
    /// The estimate from any record does not exist on some cell.
    #[error(
        "free cannot be run on case `{case}`, border `{border}`, m = {points}: {source}; lower sweep.points, raise sweep.samples, or drop the method"
    )]
    NotFromDrive {
        /// Name of the case.
        case: String,
        /// Name of the border.
        border: String,
        /// Knots `m` on each border.
        points: usize,
        /// What the method says.
        source: switchback_identify::free::FreeError,
    },
    /// A method of others cannot be asked.
    #[error(transparent)]
    NoMethod(crate::foreign::ForeignError),
    /// A method of others is a function that nobody gave.
    #[error(
        "method `{0}` is a function of whoever ran the study; give it again, as in study(…, methods={{\"{0}\": function}})"
    )]
    NobodyEstimates(
        /// Its name.
        String,
    ),
    /// An experiment of the sweep cannot be built.
    #[error("case `{case}`, m = {points}: {reason}")]
    NoExperiment {
        /// Name of the case.
        case: String,
        /// Points `m`.
        points: usize,
        /// Why.
        reason: String,
    },
}
