//! Figures of an identified rig: measured against simulated outputs, the borders, the linear part, and the residuals' correlations.

mod borders;
mod correlations;
mod linear;
mod linear_part;
mod outputs;
pub(crate) mod series;

pub use borders::borders;
pub(crate) use correlations::correlations;
pub(crate) use linear::{linear, with_error};
pub(crate) use linear_part::LinearPart;
pub use outputs::outputs;

#[cfg(test)]
mod tests;
