//! A model under diagnosis that was given, not identified: a table, or the column of another simulator.

use switchback_model::rig::{Rig, RigRecord};

use crate::error::DiagnoseError;
use crate::likelihood::engine::Fit;
use crate::localise::Residuals;
use crate::records::dataset::{Dataset, ScaledRecord, dimensionless};
use crate::settings::Model;
use crate::simulation::simulate::free_run;

/// A model as it was given: nothing of it is fitted.
#[derive(Debug)]
pub(super) struct GivenModel {
    /// The model itself, where it is known.
    pub(super) fit: Option<Fit>,
    /// Simulated outputs, one a judged record.
    pub(super) runs: Vec<Vec<f64>>,
    pub(super) residuals: Residuals,
    /// Whether the residuals are those of the output itself, not of predictions one step ahead.
    pub(super) is_output: bool,
}

impl GivenModel {
    /// The model under diagnosis; none where it is to be identified.
    pub(super) fn of(
        model: &Model,
        rig: &Rig,
        dataset: &Dataset,
        judged: &[usize],
    ) -> Result<Option<Self>, DiagnoseError> {
        Ok(match model {
            // Other records have no predictions before a system stands for them.
            Model::Identify | Model::Against(_) => None,
            Model::Given(model) => {
                let given = crate::nominal::given::scaled(dataset, model)?;
                let run = |&k: &usize| free_run(dataset, &given, k, &dataset.scaled_records[k]);
                Some(Self {
                    runs: judged.iter().map(run).collect(),
                    residuals: Residuals::of(dataset, &given),
                    is_output: false,
                    fit: Some(given),
                })
            }
            Model::Predicted => {
                let errors = |(scaled, predicted): (&ScaledRecord, Option<Vec<f64>>)| {
                    let errors = |run: Vec<f64>| {
                        scaled.y.iter().zip(run).skip(scaled.from).map(|(y, x)| y - x).collect()
                    };
                    predicted.map(errors).unwrap_or_default()
                };
                let known = predicted(rig, dataset);
                let series = dataset.scaled_records.iter().zip(known).map(errors).collect();
                let residuals = Residuals { series, simulated: true };
                Some(Self { fit: None, runs: predictions(rig, dataset, judged)?, residuals, is_output: true })
            }
        })
    }
}

/// The `y_sim` of every record that has one for each of its samples, dimensionless.
pub(super) fn predicted(rig: &Rig, dataset: &Dataset) -> Vec<Option<Vec<f64>>> {
    let scaled = |y: &Vec<f64>| dimensionless(y, dataset.y_mean, dataset.y_scale);
    let whole = |r: &RigRecord| {
        r.predicted
            .as_ref()
            .filter(|y| y.len() == r.record.len() && y.iter().all(|y| y.is_finite()))
            .map(scaled)
    };
    rig.records.iter().map(whole).collect()
}

/// The `y_sim` of the judged records, dimensionless.
fn predictions(rig: &Rig, dataset: &Dataset, judged: &[usize]) -> Result<Vec<Vec<f64>>, DiagnoseError> {
    judged
        .iter()
        .map(|&k| {
            let r = &rig.records[k];
            let found = r.predicted.as_deref().unwrap_or_default();
            if found.len() != r.record.len() {
                return Err(DiagnoseError::Prediction {
                    record: r.name.clone(),
                    found: found.len(),
                    expected: r.record.len(),
                });
            }
            if let Some((index, &value)) = found.iter().enumerate().find(|(_, x)| !x.is_finite()) {
                return Err(DiagnoseError::PredictionNotFinite { record: r.name.clone(), index, value });
            }
            Ok(dimensionless(found, dataset.y_mean, dataset.y_scale))
        })
        .collect()
}
