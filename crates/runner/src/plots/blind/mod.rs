//! Figures of a blind study, drawn from its tables alone.

mod closure;
mod confusion;
mod curves;
mod page;
mod rules;

pub use closure::closure;
pub use confusion::confusion;
pub use curves::{abstention, accuracy, calibration};
pub use page::PlotError;
pub use rules::baselines;
