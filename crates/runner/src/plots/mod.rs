//! Figures, drawn from results alone.

pub mod identify;
