//! Why no fault could be planted.

use crate::generate::make_error::MakeError;
use switchback_identify::free::FreeError;
use switchback_model::hysteresis::HysteresisError;
use switchback_model::record::RecordError;
use thiserror::Error;

/// Why no fault could be planted.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InjectionError {
    /// The records give no model.
    #[error("no model can be identified from the fit records: {0}")]
    Base(#[from] FreeError),
    /// The model misses nothing, so that nothing can be large against it.
    #[error("the model identified from the fit records leaves no residual: a size has no meaning")]
    NoResidual,
    /// The model that should carry the fault has no loop.
    #[error("the identified loop cannot carry the fault: {0}")]
    NoLoop(#[from] HysteresisError),
    /// An altered signal was no record.
    #[error("the fault gave no finite record ({0}); take a smaller size or another seed")]
    Record(#[from] RecordError),
    /// The effect or law is unknown, or the size is none.
    #[error(transparent)]
    Recipe(#[from] MakeError),
}
