//! Whose model meets the records.

use crate::model::{self, ModelError, UnitError};
use miette::Diagnostic;
use schemars::JsonSchema;
use switchback_diagnose::Model;
use switchback_identify::free;
use switchback_model::rig::{Rig, RigRecord, Usage};
use thiserror::Error;

/// Whose model is diagnosed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum Source {
    /// The nominal model identified from the fit records.
    Identified,
    /// The model file of the user.
    Given,
    /// Another simulator's predictions, the columns `y_sim`.
    #[schemars(rename = "y_sim")]
    Predicted,
}

impl Source {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Given => "given",
            Self::Predicted => "y_sim",
        }
    }

    /// What figures call its runs and errors.
    pub fn label(self) -> &'static str {
        match self {
            Self::Identified => "nominal",
            Self::Given | Self::Predicted => self.name(),
        }
    }

    /// What figures call the model itself.
    pub fn model(self) -> &'static str {
        match self {
            Self::Identified => "nominal model",
            Self::Given => "given model",
            Self::Predicted => self.name(),
        }
    }
}

/// A rig and the model that meets its records.
#[derive(Debug, Clone, PartialEq)]
pub struct Subject {
    pub(super) rig: Rig,
    pub(super) model: Model,
    pub(super) source: Source,
    /// What the reader of the report must know about the choice.
    pub(super) notes: Vec<String>,
}

/// Why the model cannot meet the records.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum SubjectError {
    /// The model file is none.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Model(#[from] ModelError),
    /// The model was identified in other units.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Units(#[from] UnitError),
    /// The model is of another order than the rig declares.
    #[error("{file}: the model has order {model}, but the rig declares `order = {rig}`")]
    #[diagnostic(help(
        "identify the model from this rig, or correct `order` in the rig file, or leave it out there"
    ))]
    Order {
        /// The model file.
        file: String,
        /// Order of the model.
        model: usize,
        /// Order in the rig.
        rig: usize,
    },
    /// The model has another sample time than the rig.
    #[error("{file}: the model has a sample time of {model} s, but the rig of {rig} s")]
    #[diagnostic(help("identify the model from records sampled as these are, or resample the records"))]
    SampleTime {
        /// The model file.
        file: String,
        /// Sample time of the model.
        model: f64,
        /// Sample time of the rig.
        rig: f64,
    },
    /// The model cannot run on a record that it is to be judged on.
    #[error("{file}: the model cannot run on the record {record}")]
    #[diagnostic(help("leave the record out, or give a model of both borders"))]
    NoRun {
        /// The model file.
        file: String,
        /// The record.
        record: String,
    },
    /// Some records have predictions and some that must have them do not.
    #[error("the record {record} has no column `y_sim`, but {other} has one")]
    #[diagnostic(help(
        "add the prediction to every record with `use = \"holdout\"`, or leave the column out of all to diagnose the model identified here"
    ))]
    Prediction {
        /// The record without a prediction.
        record: String,
        /// One with it.
        other: String,
    },
}

impl Subject {
    /// The same, with more that the reader of the report must know.
    #[must_use]
    pub fn noting(mut self, notes: Vec<String>) -> Self {
        self.notes.extend(notes);
        self
    }
}

/// A rig with the model of an identification, as `gap --model` has both: given as it is where it has the paper's structure, else by its
/// free runs.
pub fn met_by(rig: Rig, model: &free::Model) -> (Rig, Model) {
    if let Some(plain) = model::plain(model) {
        return (rig, Model::Given(plain));
    }
    let run = |record: &RigRecord| {
        let run = model.free_run(&record.record);
        (run.start < record.record.len()).then_some(run.y)
    };
    (with_predictions(rig, run), Model::Predicted)
}

/// The records a gap is measured on: the hold-outs, or all where there is none.
pub(super) fn judged(rig: &Rig) -> impl Iterator<Item = &RigRecord> {
    let any = rig.holdout_records().next().is_some();
    rig.records.iter().filter(move |record| !any || record.usage == Usage::Holdout)
}

/// The rig with a model's free run as the prediction of every record that it can run on.
pub(super) fn with_predictions(mut rig: Rig, run: impl Fn(&RigRecord) -> Option<Vec<f64>>) -> Rig {
    for record in &mut rig.records {
        record.predicted = run(record);
    }
    rig
}
