//! Figures of examinations.

use crate::plots::{self, Figure};
use switchback_lab::blind::{self, Blind};
use switchback_lab::examination::{Examination, Report};
use switchback_lab::field::{self, Field};

/// An examination whose scores can be drawn.
pub trait Drawn: Examination {
    /// Its figures.
    fn figures(&self, cases: &[Self::Case], scores: &Self::Scores) -> Vec<Figure>;
}

impl Drawn for Blind {
    fn figures(&self, cases: &[blind::Case], scores: &blind::Scores) -> Vec<Figure> {
        plots::blind::figures(cases, scores)
    }
}

impl Drawn for Field<'_> {
    fn figures(&self, _cases: &[field::Case], scores: &field::Scores) -> Vec<Figure> {
        plots::field::figures(scores)
    }
}

/// The report with its figures; `key_sha256` is the hash of the sealed keys.
///
/// # Errors
/// A table that cannot be written.
pub fn report<E: Drawn>(examination: &E, key_sha256: &str, cases: &[E::Case]) -> miette::Result<Report> {
    let scores = examination.score(cases);
    let mut report = examination.report(key_sha256, cases, &scores)?;
    for figure in examination.figures(cases, &scores) {
        report.files.add(figure.name, figure.svg);
    }
    Ok(report)
}
