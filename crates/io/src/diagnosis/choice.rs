//! Which model meets the records.

use super::given::GivenModel;
use super::subject::{Source, Subject, SubjectError, judged};
use std::path::Path;
use switchback_diagnose::Model;
use switchback_model::rig::Rig;

impl Subject {
    /// The model file if one is given, else the columns `y_sim` if the records have them, else what the fit records yield.
    ///
    /// # Errors
    /// [`SubjectError`] if the file is no model, is one of another order, or hold-out records lack their predictions.
    pub fn choose(rig: Rig, model: Option<&Path>) -> Result<Self, SubjectError> {
        Self::of(rig, model.map(GivenModel::read).transpose()?.as_ref())
    }

    /// The same with a model that was read before.
    ///
    /// # Errors
    /// [`SubjectError`] if it is of another order, or hold-out records lack their predictions.
    pub fn of(rig: Rig, model: Option<&GivenModel>) -> Result<Self, SubjectError> {
        let predicted = rig.records.iter().find(|record| record.predicted.is_some());
        match (model, predicted) {
            (Some(given), other) => {
                let notes = other
                    .map(|_| "the columns y_sim were left aside, since a model file was given".to_owned());
                given.meet(rig, notes.into_iter().collect())
            }
            (None, Some(other)) => {
                let other = other.name.clone();
                let missing = judged(&rig).find(|record| record.predicted.is_none());
                if let Some(missing) = missing {
                    return Err(SubjectError::Prediction { record: missing.name.clone(), other });
                }
                Ok(Self { rig, model: Model::Predicted, source: Source::Predicted, notes: Vec::new() })
            }
            (None, None) => {
                Ok(Self { rig, model: Model::Identify, source: Source::Identified, notes: Vec::new() })
            }
        }
    }
}
