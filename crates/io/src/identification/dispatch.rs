//! Which estimator a method is.

use super::pulse::Designed;
use super::{Identification, IdentificationError, Method, Request, free, pulse};
use switchback_identify::free::{InputMap, Progress};
use switchback_model::rig::Rig;

/// Identifies a rig from its fit records and simulates all of its records.
///
/// # Errors
/// [`IdentificationError`] if the rig lacks what the method needs, or its records do not determine a system.
pub fn identify(rig: &Rig, request: impl Into<Request>) -> Result<Identification, IdentificationError> {
    identify_watched(rig, request.into(), &())
}

/// [`identify`], which shows how far it has come.
///
/// # Errors
/// As [`identify`].
pub(crate) fn identify_watched(
    rig: &Rig,
    request: Request,
    progress: &dyn Progress,
) -> Result<Identification, IdentificationError> {
    match request.method {
        // Their switch is (2.3) and their B begins at b₁: they can always run in real time.
        Method::PaperDescendant => pulse::identify(rig, Designed::PaperDescendant),
        Method::PaperAscendant => pulse::identify(rig, Designed::PaperAscendant),
        Method::Joint => pulse::identify(rig, Designed::Joint),
        Method::Efficient => pulse::identify(rig, Designed::Efficient),
        Method::Instrumental => pulse::identify(rig, Designed::Instrumental),
        Method::Free => free::identify(rig, request, InputMap::Borders, progress),
        Method::LinearArx => free::identify(rig, request, InputMap::Linear, progress),
        Method::Memoryless => free::identify(rig, request, InputMap::Static, progress),
    }
}
