//! Figures, pages and text, drawn from results alone.

pub mod diagnosis;
pub mod examination;
pub mod identification;
pub mod pages;
pub mod plots;
pub mod power;
pub mod simulation;
pub mod study;
