//! Two result tables side by side, in units of their Monte-Carlo errors.

mod json;
mod pairs;
mod text;

pub use json::json;
pub use pairs::{Comparison, Difference, Place, compare};
pub use text::summary;
