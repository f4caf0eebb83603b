//! Two result tables side by side: their measures in units of their Monte-Carlo errors, and all else as it is.

mod beside;
mod json;
mod pairs;
mod text;
mod tree;

pub use json::json;
pub use json::schema;
pub use pairs::Comparison;
pub use pairs::Difference;
pub use pairs::compare;
pub use text::summary;
