//! Models that leave: as C, as a unit of a simulator.

mod fmu;
mod heading;
mod request;
mod target;

pub use fmu::platform;
pub use request::ExportError;
pub use request::Request;
pub use target::Target;
