//! Co-simulation FMUs of others, run over a rig's records.
//!
//! The library of an FMU is foreign code: it runs in a process of its own, which may crash or never return without harm to this one.

mod archive;
mod description;
mod error;
mod host;
mod job;
mod map;
mod predict;

pub use error::FmuError;
pub use host::host;
pub use map::Map;
pub use map::map;
pub use predict::Simulator;
pub use predict::predictions;
