//! Arithmetic for eight replicates abreast, in the widest vectors that the processor has.

mod lane;
mod wide;

pub use lane::{LANES, Lane};
pub use wide::{Work, keep_apart, widest};
