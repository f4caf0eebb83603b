//! Identification of a rig: which method, what it found, how well that simulates every record.

mod baseline;
mod causal;
mod comparison;
mod dispatch;
mod error;
mod errors_of_run;
mod examine;
mod flag;
mod found;
mod free;
mod free_run;
pub mod json;
mod method;
mod pulse;
mod request;
mod residuals;
mod result;
mod simulate;
mod table;
mod unit;

pub use baseline::Baseline;
pub(crate) use causal::obstacles;
pub use dispatch::identify;
pub(crate) use dispatch::identify_watched;
pub use error::IdentificationError;
#[cfg(test)]
use examine::examined;
pub use examine::examined_watched;
pub(crate) use flag::Flag;
pub use found::Found;
pub use free_run::FreeRun;
pub use json::json;
pub use json::schema;
pub use method::default_method;
pub use request::Request;
pub use result::CausalAlternative;
pub use result::Examination;
pub use result::Identification;
pub use simulate::EstimatedSystem;
pub use switchback_identify::Method;
pub use switchback_identify::free::fit_percent;
pub use table::table;
pub use unit::unit;

#[cfg(test)]
mod tests;
