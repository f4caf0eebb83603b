//! Figures of an identified rig: measured against simulated outputs, and the borders.

mod borders;
mod outputs;
pub(crate) mod series;

pub use borders::borders;
pub use outputs::outputs;
