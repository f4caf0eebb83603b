//! Linear systems `A(q⁻¹) y = B(q⁻¹) u + ξ`.

mod filter;

pub use filter::filter;
