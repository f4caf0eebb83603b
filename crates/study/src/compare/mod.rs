//! Two result tables side by side, in units of their Monte-Carlo errors.

mod json;
mod pairs;
mod text;

pub use json::json;
pub use json::schema;
pub use pairs::Comparison;
pub use pairs::Difference;
pub use pairs::compare;
pub use text::summary;
