//! Progress of a diagnosis or an identification.

use switchback_identify::free::Progress;

/// Receives the stages of a computation besides the pieces of work of each.
///
/// It may stop the work by unwinding with [`std::panic::resume_unwind`]: the caller catches that, and pieces running end first.
pub trait Stages: Progress {
    /// A stage of this name begins.
    fn begin(&self, stage: &'static str);
}

/// No listener.
impl Stages for () {
    fn begin(&self, _stage: &'static str) {}
}
