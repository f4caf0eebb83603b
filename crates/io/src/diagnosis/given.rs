//! A model that was identified elsewhere.

use super::Subject;
use super::model_file::{self, Given};
use super::subject::{Source, SubjectError, judged, with_predictions};
use crate::identification::EstimatedSystem;
use crate::input::{TextKind, read_text};
use crate::model::{ModelError, ModelFile, System};
use std::path::{Path, PathBuf};
use switchback_diagnose::{Model, NominalModel};
use switchback_identify::Estimate;
use switchback_model::Record;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::Rig;

/// The model of a file, which may meet any records.
#[derive(Debug)]
pub struct GivenModel {
    file: PathBuf,
    given: Given,
}

impl GivenModel {
    /// Reads a model file, or the page of an identification.
    ///
    /// # Errors
    /// [`SubjectError`] if the file is neither.
    pub fn read(file: &Path) -> Result<Self, SubjectError> {
        Self::of_text(file, &read_text(file, TextKind::Model).map_err(ModelError::from)?)
    }

    /// The same from a text; `file` is what messages call it.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn of_text(file: &Path, text: &str) -> Result<Self, SubjectError> {
        Ok(Self { given: model_file::parse(file, text)?, file: file.to_owned() })
    }

    /// The records with the model that is to be diagnosed on them.
    ///
    /// # Errors
    /// [`SubjectError`] if it is of another order, other units or another sample time, or cannot run on a record that it is judged on.
    pub fn meet(&self, rig: Rig, notes: Vec<String>) -> Result<Subject, SubjectError> {
        match &self.given {
            Given::Page(estimate) => of_page(rig, &self.file, estimate.clone(), notes),
            Given::File(model) => of_file(rig, &self.file, model, notes),
        }
    }

    /// Its free run on a record of a rig, and the first sample that is simulated; none where it cannot run.
    pub fn run(&self, rig: &Rig, record: &Record) -> Option<(Vec<f64>, usize)> {
        let run = match &self.given {
            Given::Page(estimate) => {
                let run = EstimatedSystem::new(estimate, working_interval(rig)).ok()?.run(record)?;
                (run.simulated, run.start)
            }
            Given::File(model) => {
                let run = model.run(record.v(), Some(record.y()))?;
                (run.y, run.start)
            }
        };
        (run.1 < record.len()).then_some(run)
    }
}

/// A model file. One without effects goes to the diagnosis as it is; any other is simulated here.
fn of_file(
    rig: Rig,
    file: &Path,
    model: &ModelFile,
    mut notes: Vec<String>,
) -> Result<Subject, SubjectError> {
    model.header.check_units([&rig.input_label, &rig.output_label], (file, "rig"))?;
    if !model.header.runs_at(rig.sample_time) {
        let file = file.display().to_string();
        let model = model.header.sample_time;
        return Err(SubjectError::SampleTime { file, model, rig: rig.sample_time });
    }
    let plain = match &model.system {
        System::Switched(model) => model.is_plain().then(|| model.system()),
        System::Machine(_) => None,
        System::Points(points) => return of_page(rig, file, points.estimate(), notes),
        System::Curves(curves) => curves.plain(),
    };
    if let Some(plain) = plain {
        check_order(&rig, file, plain.a.len())?;
        return Ok(Subject { rig, model: Model::Given(plain), source: Source::Given, notes });
    }
    let rig = with_predictions(rig, |record| {
        let (v, y) = (record.record.v(), record.record.y());
        model.run(v, Some(y)).filter(|run| run.start < v.len()).map(|run| run.y)
    });
    if let Some(missing) = judged(&rig).find(|record| record.predicted.is_none()) {
        return Err(SubjectError::NoRun { file: file.display().to_string(), record: missing.name.clone() });
    }
    notes.push("the model given is diagnosed by its free runs".to_owned());
    Ok(Subject { rig, model: Model::Predicted, source: Source::Given, notes })
}

/// The page of an identification, or a model of its kind.
fn of_page(rig: Rig, file: &Path, estimate: Estimate, notes: Vec<String>) -> Result<Subject, SubjectError> {
    check_order(&rig, file, estimate.a.len())?;
    let interval = working_interval(&rig);
    let system = EstimatedSystem::new(&estimate, interval).map_err(|reason| ModelError::Content {
        place: file.display().to_string(),
        message: reason.to_owned(),
        remedy: "identify again from longer records, or with another order or method".to_owned(),
    })?;
    // The paper's structure goes to the diagnosis as it is; one with another delay is simulated here.
    let (rig, model) = if estimate.delay == 0 {
        let [descending, ascending] = system.borders().map(<[_]>::to_vec);
        let model = NominalModel { a: estimate.a.clone(), b: estimate.b.clone(), descending, ascending };
        (rig, Model::Given(model))
    } else {
        (
            with_predictions(rig, |record| system.run(&record.record).map(|run| run.simulated)),
            Model::Predicted,
        )
    };
    Ok(Subject { rig, model, source: Source::Given, notes })
}

fn working_interval(rig: &Rig) -> Interval {
    let v = rig.fit_records().flat_map(|record| record.record.v());
    let (low, high) = v.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
    let moved = Interval::new(low, high).expect("a rig that was read moves in its fit records");
    rig.interval.unwrap_or(moved)
}

/// Whether the model has the order that the rig declares.
fn check_order(rig: &Rig, file: &Path, model: usize) -> Result<(), SubjectError> {
    match rig.order.filter(|order| *order != model) {
        Some(order) => Err(SubjectError::Order { file: file.display().to_string(), model, rig: order }),
        None => Ok(()),
    }
}
