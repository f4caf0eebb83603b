//! Arithmetic for eight replicates abreast, in the widest vectors that the processor has.

mod lane;
mod wide;

pub use lane::{LANES, Lane};
pub(crate) use wide::keep_apart;
pub use wide::{Work, widest};
