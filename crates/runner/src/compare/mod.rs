//! Two result tables side by side, in units of their Monte-Carlo errors.

mod pairs;
mod quantiles;
mod text;

pub use pairs::{Comparison, Difference, Place, compare};
pub use quantiles::quantiles;
pub use text::summary;
