//! Evidence: columns of numbers that tell which effect a nominal system misses.
//!
//! ```text
//! r = y − ŷ(θ)        error of the free run
//! J = ∂ŷ/∂θ           directions that the fit has taken
//! g = ŷ(θ, effect) − ŷ(θ)     a candidate's change of the run
//! ```
//!
//! All three are filtered by an autoregressive model, and `J` is projected out of `r` and `g`. The share of the energy of `r` that `g` explains, over all samples, in
//! blocks by coefficients of the others, beside the best other candidate; and the same of each law at its own optimum. Metrics: `f` free run, `w` filtered so that
//! `r` is white, `v` so that the remainder beside the best candidates is white. Beside these the shape of `r`. Columns are named `EFFECT.STATISTIC` or `STATISTIC`; none
//! changes with the units of input or output.

mod candidate;
mod candidates;
mod columns;
mod context;
mod grams;
mod likelihood;
mod lines;
mod nominal;
mod refine;
mod rig;
mod score;
mod setting;
mod shape;
mod shapes;

pub use columns::{EffectFit, Evidence};
pub(crate) use nominal::{behind, nominal};
pub use rig::Judged;

#[cfg(test)]
mod tests;
