//! Fits of a whole [`System`](switchback_model::system::System), effects among it, to any records: one criterion, some quantities free and the others fixed.
//!
//! ```text
//! minimise Σ ρ(D(q⁻¹)(y − ŷ(θ)))    over the free quantities of θ
//! ```
//!
//! `ŷ` is the free run, `D` the autoregressive model of its error ([`noise_model`](switchback_model::noise_model)), `ρ` Huber's function. The state with which a record
//! begins is unknown: its traces are projected out.

mod bare;
mod chord;
mod criterion;
mod fit;
mod sensitivities;
mod stretch;

pub use bare::bare_system;
pub use chord::Chord;
pub use criterion::Criterion;
pub use fit::{Effort, fit};
pub use sensitivities::{Sensitivities, filter_and_project};
pub use stretch::Stretch;
