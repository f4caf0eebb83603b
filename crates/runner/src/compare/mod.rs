//! Two result tables side by side, in units of their Monte-Carlo errors.

mod json;
mod pairs;
mod quantiles;
mod text;

pub use json::json;
pub use pairs::{Comparison, Difference, Place, compare};
pub use quantiles::quantiles;
pub use text::summary;
