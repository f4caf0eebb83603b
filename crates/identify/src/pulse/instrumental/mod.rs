//! Consistent where the equation error is not white: the response to a periodic input, distinguished from the noise by averaging over periods.
//!
//! ```text
//! Ȳ_k = Σ_p ȳ_p e^{−jω_k p} = Z_k(θ) + Ē_k,   ω_k = 2πk/T
//! Z_k = B(e^{jω_k})/A(e^{jω_k}) · U_k(w) + T o [k = 0]
//! θ̂  = argmin Σ_k |Ȳ_k − Z_k(θ)|² / S(ω_k)
//! ```
//!
//! `ȳ` are the means of the output over the periods ([`Folds`](super::Folds)), `U` the transform of `w = u − u_m` over one period, `o` the output
//! held at `u_m`. The noise of the output, of which nothing is asked but that it be stationary and not caused by the input, has the
//! spectrum `S`; `Ē` has variance `T S(ω_k)/K`, uncorrelated between lines as the number of periods `K` grows. `S` is that of an autoregression
//! through the autocovariances that the folds leave ([`colour`]).
//!
//! Because the input is known and repeats, the mean output is made of nothing but the input: it is an instrument. With the model's response `Z`
//! in the place of the lagged outputs the Gauss–Newton step is that of refined instrumental variables, and its limit is the maximum of
//! the likelihood of the folds, so that no estimate from them that knows nothing of the noise's law has less variance.
//!
//! Söderström and Stoica, "Instrumental Variable Methods for System Identification" (1983), chapters 4 and 6; Young, "Recursive Estimation and
//! Time-Series Analysis" (2011), chapter 7; Pintelon and Schoukens, "System Identification: A Frequency Domain Approach" (2012), chapter 12 (periodic
//! excitation, sample means and noise covariances).

/// Gauss–Newton steps from the start on.
///
/// The start errs by `N^(−1/2)`, and each step leaves a product of its error and of `N^(−1/2)`, as the residual's part of the Hessian is left out: after two the
/// distance to the optimum is of order `N^(−3/2)`, beside an error of order `N^(−1/2)` and a bias of order `1/N`.
pub(super) const STEPS: usize = 2;

mod colour;
mod problem;
mod solution;

pub(super) use solution::KnownColour;
pub(crate) use solution::{FoldedSolution, instrumental};
