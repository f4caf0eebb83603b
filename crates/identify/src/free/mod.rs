//! Identification from any record: no designed experiment.
//!
//! Where the switched model holds, the branch at every sample is known from `v` alone ([`switchback_model::reversal::Branches`]). On a grid of knots ([`Basis`]) `u` is
//! then linear in the border values, and `y` obeys a linear regression with one coefficient for every product `bᵢf_k`:
//! least squares, then rank one ([`one_shot`]). On real records the equation error is not white and such a model
//! simulates badly, so [`identify`] goes on to minimise the error of the free run, and chooses order, delay and
//! knots by cross-validation on the records it is given.
//!
//! The error of the free run needs no white noise to be consistent. Where it is coloured, the noise is modelled apart and the estimate made from filtered
//! errors ([`FitKind::Prewhitened`]).
//!
//! [`InputMap`] makes the same machinery fit what a user would otherwise pick: a straight line (`linear-arx`) or one
//! static curve (`memoryless`), so that a comparison compares the models and not the effort.
//!
//! Intervals come from a grid that is refined until its bias is small against the noise, and beside a jump they span both sides (`undersmoothing`;
//! [`NestedRegressions`] for many outputs of one input).
//!
//! Weak points, each reported as a [`Warning`]: a jump inside a cell of the grid; knots that few samples visit; sensor noise
//! on `v`, which fakes reversals, and moves estimates by a bias whose size [`InputNoise`] works out; a model that needs `v` ahead of time. What no warning can show: a static
//! nonlinearity in series with `v` and a common offset look like other borders.

mod basis;
mod cells;
mod cross_validation;
mod data;
mod doubt;
mod equation_error;
mod error;
mod errors;
mod examination;
mod fit;
mod free_run;
mod grid_bias;
mod halving;
mod identify;
mod input_noise;
mod jumps;
mod limit;
mod model;
mod nested;
mod nesting;
mod normalise;
mod one_shot;
mod problem;
mod progress;
mod rank_one;
mod regression;
mod rules;
mod runs;
mod selection;
mod settings;
mod simulation_error;
mod smoothing;
mod undersmoothing;
mod units;
mod warning;

pub use basis::Basis;
pub use equation_error::Moments;
pub use error::FreeError;
pub use fit::FitKind;
pub use free_run::Output;
pub use identify::Identified;
pub use identify::identify;
pub use identify::identify_watched;
pub use input_noise::InputNoise;
pub use limit::Limit;
pub use model::Coefficients;
pub use model::Model;
pub use model::fit_percent;
pub use nested::NestedRegressions;
pub use one_shot::Grid;
pub use one_shot::one_shot;
pub use problem::Structure;
pub use progress::Progress;
pub use regression::Regression;
pub use selection::Selection;
pub use settings::InputMap;
pub use settings::Settings;
pub use warning::Warning;

#[cfg(test)]
mod tests;
