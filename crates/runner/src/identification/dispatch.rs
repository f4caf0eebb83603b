//! Which estimator a method is.

use super::{Identification, IdentificationError, Method, free, pulse};
use switchback_estimator::estimators::free::InputMap;
use switchback_estimator::rig::Rig;

/// Identifies a rig from its fit records and simulates all of its records.
///
/// # Errors
/// [`IdentificationError`] if the rig lacks what the method needs, or its records do not determine a system.
pub fn identify(rig: &Rig, method: Method) -> Result<Identification, IdentificationError> {
    match method {
        Method::PaperDescendant | Method::PaperAscendant | Method::Joint | Method::Efficient => {
            pulse::identify(rig, method)
        }
        Method::Free => free::identify(rig, method, InputMap::Borders),
        Method::LinearArx => free::identify(rig, method, InputMap::Linear),
        Method::Memoryless => free::identify(rig, method, InputMap::Static),
    }
}
