//! Two result tables side by side, in units of their Monte-Carlo errors.

mod overlay;
mod pairs;
mod text;

pub use overlay::overlay;
pub use pairs::{Comparison, Difference, Place, compare};
pub use text::summary;
