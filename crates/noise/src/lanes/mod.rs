//! Arithmetic for eight replicates abreast, in the widest vectors that the processor has.

mod lagged;
mod lane;
mod products;
mod wide;

pub use lagged::{Columns, Lagged};
pub use lane::LANES;
pub use lane::Lane;
pub use products::Products;
pub use wide::Work;
pub use wide::keep_apart;
pub use wide::widest;
