//! What is known before any effect is tried.

use switchback_model::rig::Rig;

use super::given_model::GivenModel;
use super::nominal::Nominal;
use crate::attribution::PairEffort;
use crate::attribution::explain::Hypothesis;
use crate::error::DiagnoseError;
use crate::export::Exporter;
use crate::nominal::order::Chosen;
use crate::nominal::structure::Structure;
use crate::posterior::Classification;
use crate::records::dataset::Dataset;
use crate::settings::{Model, Settings};

/// A rig unlike those that the posterior was trained on.
const OUTSIDE: &str = "the records are unlike those that the posterior was trained on: farther from these than 99 of 100 rigs that were held out; its \
                                  probabilities only rank, and nothing is named";

/// A rig without evidence.
const WITHOUT_EVIDENCE: &str = "the records show no system of which evidence could be had: before they were fitted all causes were taken to be as likely as each \
                                other, and nothing is named";

/// What is known before any effect is tried.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) settings: Settings,
    pub(super) dataset: Dataset,
    /// The nominal model as identified here.
    pub(super) nominal: Nominal,
    /// The model under diagnosis, where it is not the identified one.
    pub(super) given: Option<GivenModel>,
    /// Tracks the gap is measured on, and what the model under diagnosis makes of them.
    pub(super) judged: Vec<usize>,
    pub(super) runs: Vec<Vec<f64>>,
    /// That of the nominal model.
    pub(super) structure: Structure,
    /// How far two effects are looked for.
    pub(super) pair_effort: PairEffort,
    /// Whether the colour of the noise belongs to the model, and is no cause: of records that nobody designed.
    pub(super) owns_colour: bool,
    /// Whether probabilities were calibrated on records and models like these.
    pub(super) is_calibrated: bool,
    pub(super) limitations: Vec<String>,
    pub(super) exporter: Exporter,
}

impl Plan {
    /// Lays out what a diagnosis of the chosen nominal model starts from.
    pub(super) fn new(
        rig: &Rig,
        model: &Model,
        settings: &Settings,
        chosen: Chosen,
    ) -> Result<Self, DiagnoseError> {
        let Chosen { dataset, fit, structure, reported } = chosen;
        let declared = reported.is_none();
        let mut settings = settings.clone();
        let mut limitations = Vec::from_iter(reported);
        if dataset.criterion.simulates() {
            // What changes only the noise moves no simulation.
            settings.effects.retain(|e| !e.moves_no_simulation());
        }
        let judged = judged_scaled_records(&dataset, &mut limitations);
        let given = GivenModel::of(model, rig, &dataset, &judged)?;
        note_what_the_records_lack(&dataset, &mut limitations);
        let nominal = Nominal::new(&dataset, &settings, Hypothesis::nominal(fit));
        let runs = match &given {
            Some(given) => given.runs.clone(),
            None => nominal.runs(&dataset, &judged),
        };
        let pair_effort = if dataset.criterion.simulates() { PairEffort::Forward } else { PairEffort::Full };
        let owns_colour =
            !declared && !dataset.is_designed() && !settings.asked.iter().any(|e| e.card().colours_noise);
        let exporter = Exporter::new(rig);
        let holds_out = dataset.scaled_records.iter().any(|t| !t.is_fit());
        let is_calibrated = declared && holds_out && given.is_none() && !dataset.criterion.simulates();
        Ok(Self {
            settings,
            dataset,
            nominal,
            given,
            judged,
            runs,
            structure,
            pair_effort,
            owns_colour,
            is_calibrated,
            limitations,
            exporter,
        })
    }

    /// Whether the structure of the model is known, so that likelihoods of its predictions are those of the machine: an order is declared, experiments
    /// were designed, or the colour of noise is asked for.
    pub(super) fn weighs_likelihoods(&self) -> bool {
        !self.owns_colour && !self.dataset.criterion.simulates()
    }

    /// Founds the diagnosis on another optimum of the nominal model.
    pub(super) fn found_on(&mut self, nominal: Nominal) {
        if self.given.is_none() {
            self.runs = nominal.runs(&self.dataset, &self.judged);
        }
        self.nominal = nominal;
    }
}

/// Why no evidence counts, where that is so.
pub(super) fn lacks(classification: &Classification) -> Option<String> {
    let reason = if classification.rows == 0 { WITHOUT_EVIDENCE } else { OUTSIDE };
    classification.is_outside().then(|| reason.to_owned())
}

/// The hold-out records; without any, the fit records, with a word about it.
pub(super) fn judged_scaled_records(dataset: &Dataset, limitations: &mut Vec<String>) -> Vec<usize> {
    let numbers = |fit: bool| {
        dataset
            .scaled_records
            .iter()
            .enumerate()
            .filter(|(_, t)| t.is_fit() == fit && t.from + 20 < t.v.len())
            .map(|(i, _)| i)
            .collect::<Vec<usize>>()
    };
    let held_out = numbers(false);
    if held_out.is_empty() {
        limitations.push(
            "no held-out record can be judged (there is none, it is too short, or its input never moves): gap and closure are \
             measured on the records the models were fitted to, which flatters them; hold a record out in which the input moves"
                .into(),
        );
        return numbers(true);
    }
    held_out
}

pub(super) fn note_what_the_records_lack(dataset: &Dataset, limitations: &mut Vec<String>) {
    for scaled in dataset.scaled_records.iter().filter(|t| t.y.iter().all(|y| *y == t.y[0])) {
        limitations.push(format!(
            "y never moves in `{}`: its sensor may have been off; check the record, or leave it out",
            scaled.name
        ));
    }
    if dataset.fit().all(|t| t.is_pulsed()) {
        limitations.push(
            "no free record among the fit records: pulse experiments cannot see backlash or gradual transition, and hardly \
             rate dependence; add a free record with reversals of many sizes"
                .into(),
        );
    }
    if dataset.scaled_records.iter().all(|t| t.period.is_none()) {
        limitations.push(
            "no record repeats its input three times: noise is distinguished from the systematic part by the model's floor alone"
                .into(),
        );
    }
    if dataset.rule.threshold > 0.0 {
        limitations.push(format!(
            "noise on v fakes reversals: moves below {:.3e} input units against the branch were not counted as such",
            dataset.rule.threshold * dataset.v_width
        ));
    }
}
