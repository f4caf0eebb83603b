//! Hammerstein systems with a switched hysteresis: systems, experiments, estimators and their statistics.
//!
//! The system is `A(q⁻¹) y(t) = B(q⁻¹) u(t) + ξ(t)`, `u = F[v]`, where the working point runs on one of two
//! borders and switches to the other at every reversal of `v` (Rochdi, Giri, Chaoui, "Identification of
//! Hammerstein systems including a nonparametric switched-hysteresis element", SYSID 2009, pp. 342–347,
//! doi 10.3182/20090706-3-FR-2004.0370). Equation numbers in these pages are that paper's.
//!
//! The crate is pure: no files, clocks, threads or ambient randomness.

pub mod estimators;
pub mod excitation;
pub mod hysteresis;
pub mod lanes;
pub mod linear;
pub mod record;
pub mod rig;
pub mod simulation;
pub mod statistics;

pub use record::{Record, RecordError};
