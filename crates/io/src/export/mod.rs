//! Models that leave: as Python, as C, as a unit of a simulator.

mod fmu;
mod heading;
mod target;

pub use fmu::{LibraryError, fmu, library, platform};
pub use heading::{heading, name_from};
pub use target::Target;
