//! Which estimator a method is.

use super::{Identification, IdentificationError, Method, Request, free, pulse};
use switchback_estimator::estimators::free::InputMap;
use switchback_estimator::rig::Rig;

/// Identifies a rig from its fit records and simulates all of its records.
///
/// # Errors
/// [`IdentificationError`] if the rig lacks what the method needs, or its records do not determine a system.
pub fn identify(rig: &Rig, request: impl Into<Request>) -> Result<Identification, IdentificationError> {
    let request = request.into();
    match request.method {
        // Their switch is (2.3) and their B begins at b₁: they can always run in real time.
        Method::PaperDescendant | Method::PaperAscendant | Method::Joint | Method::Efficient => {
            pulse::identify(rig, request.method)
        }
        Method::Free => free::identify(rig, request, InputMap::Borders),
        Method::LinearArx => free::identify(rig, request, InputMap::Linear),
        Method::Memoryless => free::identify(rig, request, InputMap::Static),
    }
}
