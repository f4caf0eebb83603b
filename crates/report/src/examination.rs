//! Reports of examinations, with their figures.

use crate::plots;
use switchback_lab::examination::{Case, Examination, Report};

/// The report with its figures; `key_sha256` is the hash of the sealed keys.
pub fn report(examination: &Examination<'_>, key_sha256: &str, cases: &[Case]) -> Report {
    let scores = examination.score(cases);
    let mut report = examination.report(key_sha256, cases, &scores);
    for figure in plots::examination::figures(examination.study().design, &scores) {
        report.files.add(figure.name, figure.svg);
    }
    report
}
