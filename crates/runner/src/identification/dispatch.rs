//! Which estimator a method is.

use super::{Identification, IdentificationError, Method, pulse};
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
        Method::Free | Method::LinearArx | Method::Memoryless => Err(IdentificationError::Refused {
            rig: rig.name.clone(),
            method,
            reason: "this build holds the pulse methods only".to_owned(),
            remedy: "choose `--method efficient`".to_owned(),
        }),
    }
}
