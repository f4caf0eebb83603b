//! Figures, pages and text, drawn from results alone.

pub mod diagnosis;
pub mod examination;
pub mod pages;
pub mod plots;
pub mod study;
