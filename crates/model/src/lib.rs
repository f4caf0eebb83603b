//! Records and rigs, the switched hysteresis, the linear part, and causal models that run sample by sample.
//!
//! ```text
//! A(q⁻¹) y(t) = B(q⁻¹) u(t) + ξ(t),   A = 1 + a₁q⁻¹ + … + aₙq⁻ⁿ,   B = b₁q⁻¹ + … + bₙq⁻ⁿ
//! u(t) = C_a(v(t)) while v rises, C_d(v(t)) while v falls, u(t−1) while v stands still
//! ```
//!
//! | module | contents |
//! |---|---|
//! | [`record`], [`rig`] | measurements: one record; the records of one machine |
//! | [`hysteresis`], [`linear`] | the two parts of a system |
//! | [`reversal`] | the branch of every sample, and the strokes between reversals |
//! | [`noise_model`] | the autoregression of the noise |
//! | [`spectrum`], [`sums`] | periodograms and autocorrelations of signals; inner products |
//! | [`alignment`] | sign, factor and delay between two outputs |
//! | [`change_point`], [`energy`] | instants at which a regression changes; energy of errors over cells |
//! | [`stray`] | samples that no measurement can be |
//! | [`system`] | a machine with terms for effects: simulated, differentiated, compared |
//! | [`step`] | a causal model as a small program, run here or printed as C |
//!
//! The crate is pure: no files, clocks, threads or ambient randomness.

pub mod alignment;
pub mod change_point;
mod derivative;
pub mod energy;
pub mod hysteresis;
pub mod linear;
pub mod noise_model;
pub mod record;
pub mod reversal;
pub mod rig;
pub mod spectrum;
pub mod step;
pub mod stray;
pub mod sums;
pub mod system;
#[cfg(test)]
mod testing;

pub use record::Record;
