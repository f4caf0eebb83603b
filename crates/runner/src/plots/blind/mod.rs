//! Figures of a blind study, drawn from its tables alone.

mod closure;
pub(super) mod confusion;
pub(super) mod curves;
mod page;
mod rules;

pub use page::PlotError;

use super::Figure;
use crate::blind::{Case, Scores};

/// Every figure.
///
/// # Errors
/// [`PlotError`] for a figure that could not be drawn.
pub fn figures(cases: &[Case], scores: &Scores) -> Result<Vec<Figure>, PlotError> {
    let figures = [
        ("confusion.svg", confusion::confusion(&scores.confusion, "surviving gap ≥ 1 sd")?),
        ("accuracy.svg", curves::accuracy(&scores.sizes)?),
        ("calibration.svg", curves::calibration(&scores.calibration.bins)?),
        ("abstention.svg", curves::abstention(&scores.abstention)?),
        ("closure.svg", closure::closure(cases)?),
        ("baselines.svg", rules::baselines(&scores.baselines)?),
    ];
    Ok(figures.map(|(name, svg)| Figure { name: name.to_owned(), svg }).into())
}
