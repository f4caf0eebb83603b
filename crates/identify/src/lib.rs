//! Hammerstein systems with a switched hysteresis: systems, experiments, estimators and their statistics.
//!
//! ```text
//! A(q⁻¹) y(t) = B(q⁻¹) u(t) + ξ(t),   A = 1 + a₁q⁻¹ + … + aₙq⁻ⁿ,   B = b₁q⁻¹ + … + bₙq⁻ⁿ
//! u(t) = C_a(v(t)) while v rises, C_d(v(t)) while v falls, u(t−1) while v stands still
//! ```
//!
//! `v` and `y` are measured. Both borders `C_a` and `C_d`, the coefficients, and their standard errors are estimated: from designed experiments by
//! [`pulse`], from any record by [`free`]. From vectors:
//!
//! ```
//! use switchback_model::Record;
//! use switchback_identify::free::{InputMap, Settings, identify};
//!
//! // A record: put your own measurements here. This machine follows v + 0.5 while v rises and v − 0.5 while it falls, behind a first-order lag.
//! let v: Vec<f64> = (0..2000).map(|t| (0.17 * t as f64).sin() * (0.013 * t as f64).cos()).collect();
//! let (mut y, mut u) = (vec![0.0], 0.0);
//! for t in 1..v.len() {
//!     y.push(0.6 * y[t - 1] + 0.4 * u);
//!     u = if v[t] > v[t - 1] { v[t] + 0.5 } else { v[t] - 0.5 };
//! }
//! let record = Record::new(v, y)?;
//!
//! let settings = Settings { order: Some(1), delay: Some(0), knots: Some(5), ..Settings::new(InputMap::Borders) };
//! let found = identify(&[&record], &settings)?;
//! assert!((found.estimate.a[0] + 0.6).abs() < 0.01);
//! // Borders are reported in units of u_M − u_m; `gain` restores the output's. The loop is one unit wide.
//! let (rising, falling) = (&found.estimate.ascending[2], &found.estimate.descending[2]);
//! assert!((found.estimate.gain * (rising.f - falling.f) - 1.0).abs() < 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`excitation`] | experiments that mask the memory of the hysteresis |
//! | [`simulation`] | periodic responses in closed form, and the sufficient statistics of an experiment by superposition |
//! | [`pulse`] | estimators for the designed experiments: the paper's, the efficient one, simpler models to compare with |
//! | [`free`] | the estimator for any record |
//! | [`record`] | a whole system, effects among it, fitted to any records, its quantities free or fixed |
//! | [`statistics`] | standard errors, jackknife, block bootstrap, tests of whiteness |
//!
//! Source: Y. Rochdi, F. Giri, F. Z. Chaoui, "Identification of Hammerstein systems including a nonparametric switched-hysteresis element", SYSID 2009,
//! pp. 342–347, doi 10.3182/20090706-3-FR-2004.0370. Equation numbers in these pages are that paper's; `examples/corrections.rs` shows where it must be read
//! with care.
//!
//! The crate is pure: no files, clocks, threads or ambient randomness.

mod border_distance;
mod estimate;
pub mod excitation;
pub mod free;
pub mod method;
mod plus_minus;
pub mod pulse;
pub mod record;
pub mod simulation;
pub mod statistics;

pub use border_distance::BorderDistance;
pub use estimate::BorderPoint;
pub use estimate::Coefficient;
pub use estimate::Estimate;
pub use estimate::LevelErrors;
pub use method::Method;
pub use plus_minus::PlusMinus;
