//! Figures of a field examination, drawn from its tables alone.

use super::Figure;
use super::blind::{PlotError, confusion, curves};
use crate::field::Scores;

/// Every figure.
///
/// # Errors
/// [`PlotError`] for a figure that could not be drawn.
pub fn figures(scores: &Scores) -> Result<Vec<Figure>, PlotError> {
    let figures = [
        ("confusion.svg", confusion::confusion(&scores.confusion, "size ≥ 2")?),
        ("calibration.svg", curves::calibration(&scores.claims.bins)?),
    ];
    Ok(figures.map(|(name, svg)| Figure { name: name.to_owned(), svg }).into())
}
