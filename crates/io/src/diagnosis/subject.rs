//! Whose model meets the records.

use crate::identification::unit;
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
    /// Records of another machine, or of the same on another day.
    Against,
}

impl Source {
    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Given => "given",
            Self::Predicted => "y_sim",
            Self::Against => "against",
        }
    }

    /// What figures call its runs and errors.
    pub fn label(self) -> &'static str {
        match self {
            Self::Identified => "nominal",
            Self::Given | Self::Predicted => self.name(),
            Self::Against => "other records",
        }
    }

    /// What figures call the model itself.
    pub fn model(self) -> &'static str {
        match self {
            Self::Identified => "nominal model",
            Self::Given => "given model",
            Self::Predicted => self.name(),
            Self::Against => "model of the other records",
        }
    }

    /// The same in a sentence.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Identified => "the model identified from the fit records",
            Self::Given => "the given model",
            Self::Predicted => "y_sim",
            Self::Against => "the model of the other records",
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
    #[diagnostic(help(
        "identify the model from records sampled as these are, or bring the records to the model's sample time: add `--resample --sample-time {model}`"
    ))]
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
    /// The records compared with have another sample time.
    #[error("the records compared with have a sample time of {other} s, those of the machine {rig} s")]
    #[diagnostic(help("resample one of both, e.g. with `--rate`, so that both have the same sample time"))]
    AgainstSampleTime {
        /// Sample time of the records compared with.
        other: f64,
        /// Sample time of the machine's.
        rig: f64,
    },
    /// The records compared with have another unit.
    #[error(
        "the {signal} is in [{other}] in the records compared with, but in [{rig}] in those of the machine"
    )]
    #[diagnostic(help("convert one of both, or correct the unit in its header or manifest"))]
    AgainstUnit {
        /// Input or output.
        signal: &'static str,
        /// Unit in the records compared with.
        other: String,
        /// Unit in the machine's.
        rig: String,
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

/// Relative difference of two sample times that is none.
const SAME_TIME: f64 = 1e-3;

impl Subject {
    /// A machine and the records of another, or of the same on another day. A `y_sim` in either is left aside.
    ///
    /// # Errors
    /// [`SubjectError`] if the sample times or the units that both name differ.
    pub fn against(mut rig: Rig, other: &Rig) -> Result<Self, SubjectError> {
        if ((other.sample_time - rig.sample_time) / rig.sample_time).abs() > SAME_TIME {
            return Err(SubjectError::AgainstSampleTime { other: other.sample_time, rig: rig.sample_time });
        }
        let labels = [
            ("input", &rig.input_label, &other.input_label),
            ("output", &rig.output_label, &other.output_label),
        ];
        for (signal, here, there) in labels {
            let (here, there) = (unit(here), unit(there));
            if !here.is_empty() && !there.is_empty() && here != there {
                return Err(SubjectError::AgainstUnit {
                    signal,
                    other: there.to_owned(),
                    rig: here.to_owned(),
                });
            }
        }
        rig.records.iter_mut().for_each(|record| record.predicted = None);
        let records = other.records.iter().map(|record| record.record.clone()).collect();
        Ok(Self { rig, model: Model::Against(records), source: Source::Against, notes: Vec::new() })
    }

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
