//! The reversal rule: which border the working point is on, read off the input alone.

mod branches;
mod sensor;
mod strokes;

pub use branches::{Branches, LEADS_PER_SAMPLE, LookAhead, ReversalRule, Timing};
pub use sensor::SensorNoise;
pub use strokes::{Stroke, Strokes};
