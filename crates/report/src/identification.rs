//! The files of an identification.

use crate::pages::{self, PageError};
use crate::plots;
use switchback_io::identification::json::EstimateFile;
use switchback_io::identification::{self, Identification};
use switchback_io::model;
use switchback_io::output::Artefacts;
use switchback_model::rig::Rig;

/// `estimate.json`, the model where the estimate can run, `series.csv`, the figures and the page `index.html`.
///
/// # Errors
/// [`PageError`] if a figure is no drawing.
pub fn artefacts(rig: &Rig, identification: &Identification) -> Result<Artefacts, PageError> {
    let mut artefacts = Artefacts::default();
    artefacts.add("estimate.json", identification::json(rig, identification));
    if let Some(model) = model::identified(rig, identification) {
        artefacts.add("model.json", model.text());
    }
    artefacts.add("series.csv", model::identified_series(rig, identification).text());
    for (record, run) in rig.records.iter().zip(&identification.runs) {
        let Some(run) = run else { continue };
        let name = format!("measured_and_simulated_{}.svg", record.name);
        artefacts.add(name, plots::identify::outputs(rig, record, run));
    }
    if let Some(svg) = plots::identify::borders(&EstimateFile::of(rig, identification)) {
        artefacts.add("borders.svg", svg);
    }
    pages::bound(artefacts)
}
