//! Figures, drawn from results alone.

pub mod blind;
pub mod identify;
