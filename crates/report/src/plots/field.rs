//! Figures of a field examination, drawn from its tables alone.

use super::Figure;
use super::blind::{confusion, curves};
use switchback_lab::field::Scores;

/// Every figure.
pub(crate) fn figures(scores: &Scores) -> Vec<Figure> {
    let figures = [
        ("confusion.svg", confusion::confusion(&scores.confusion, "size ≥ 2")),
        ("calibration.svg", curves::calibration(&scores.claims.bins)),
    ];
    figures.map(|(name, svg)| Figure { name: name.to_owned(), svg }).into()
}
