//! The files of a diagnosis.

use super::{json, words};
use crate::pages::{self, PageError};
use crate::plots;
use switchback_io::diagnosis::{self, Report};
use switchback_io::model;
use switchback_io::output::Artefacts;

/// `gap.json`, the models, `series.csv`, `verdict.txt`, the figures, the next experiment and the page `index.html`.
///
/// # Errors
/// [`PageError`] if a figure is no drawing.
pub fn artefacts(report: &Report) -> Result<Artefacts, PageError> {
    let mut artefacts = Artefacts::default();
    artefacts.add("gap.json", json::json(report));
    for (name, file) in model::diagnosed(report) {
        artefacts.add(name, file.text());
    }
    artefacts.add("series.csv", model::diagnosed_series(report).text());
    artefacts.add("verdict.txt", words::verdict(report));
    for figure in plots::gap::figures(report) {
        artefacts.add(figure.name, figure.svg);
    }
    if let Some(csv) = diagnosis::next_experiment(report) {
        artefacts.add(diagnosis::NEXT_EXPERIMENT, csv);
    }
    pages::bound(artefacts)
}
