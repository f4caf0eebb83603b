//! Differences between a machine and a source that is compared with it.
//!
//! ```text
//! ŷ(θ_A + δ) = gain·shift(c + ŷ_s(θ_A + δ; v)) + zero,   c = y_A − ŷ_s(θ_A; v)
//! ```
//!
//! `y_A` is the prediction of the source on the machine's records, `ŷ_s` a system identified from `(v, y_A)`, with the effects of that side
//! (`surrogate`). The carrier `c` keeps everything that the system leaves open, so that at `δ = 0` the prediction is exactly the source's own;
//! where differences are fitted it lacks the traces of the source's initial state, which is not the machine's. Each quantity of the
//! system, and each effect that it lacks, is a candidate for a difference; stepwise selection finds those that the machine's records call for (`selection`).

mod errors;
mod missing;
mod pair;
mod reversals;
mod rows;
mod selection;
mod source;
mod surrogate;

pub use missing::is_imitation;
pub(crate) use missing::{causes, missing};
pub use pair::{Basis, Differences, MachineRecord, Shift, compare, compare_with};
pub use rows::{Row, RowKind};
pub use source::Source;
