//! A source that a machine is compared with.

use super::errors::errors;
use super::surrogate::{stretches, surrogate};
use crate::evidence::nominal;
use crate::workers::Workers;
use switchback_identify::free::FreeError;
use switchback_identify::record::{Criterion, Sensitivities, Stretch};
use switchback_model::Record;
use switchback_model::reversal::ReversalRule;
use switchback_model::system::System;

/// What a machine is compared with.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// The prediction of a simulator on each of the machine's records.
    Predictions,
    /// A model.
    Model(Box<System>),
    /// Records of another machine, or of the same on another day.
    Records(Vec<Record>),
}

/// The source as a system, and the records from which that was identified.
pub(super) struct Identified {
    pub(super) system: System,
    pub(super) records: Vec<Stretch>,
    /// Whether its predictions on the machine's records are known.
    pub(super) is_carried: bool,
}

impl Identified {
    /// Sum of its squared errors over the variance of the machine's noise. Records of another machine have noise of their own, beside which a misfit is not
    /// seen: it may be any.
    pub(super) fn misfit(&self, noise: f64) -> f64 {
        if !self.is_carried && !self.records.is_empty() {
            return f64::INFINITY;
        }
        Sensitivities::deviance(&self.system, &self.records, &Criterion { filter: Vec::new(), sd: noise })
    }

    /// The system on borders dense enough for a change of their curvature, continued over the range of the machine's input. Where a law moves reversals, the rule that places these without it is not seen in the
    /// source, and is the machine's.
    pub(super) fn base(&self, machine: ReversalRule, range: (f64, f64)) -> System {
        let is_open = self.system.terms.iter().any(|term| term.law.moves_reversals());
        let rule = if is_open { machine } else { self.system.rule };
        System { borders: self.system.borders.dense().continued(range), rule, ..self.system.clone() }
    }
}

impl Source {
    /// The system that stands for the source. `predicted` are the machine's inputs with the source's predictions, `noise` the standard deviation of the
    /// machine's noise in units of these.
    pub(super) fn identified(
        &self,
        workers: &impl Workers,
        predicted: &[Record],
        noise: f64,
    ) -> Result<Option<Identified>, FreeError> {
        let found = |records: &[Record], noise, is_carried| {
            let records: Vec<&Record> = records.iter().collect();
            let system = surrogate(workers, &records, noise)?;
            Ok(system.map(|system| Identified { records: stretches(&records, &system), system, is_carried }))
        };
        Ok(match self {
            Self::Predictions => found(predicted, noise, true)?,
            Self::Model(system) => {
                Some(Identified { system: System::clone(system), records: Vec::new(), is_carried: false })
            }
            Self::Records(records) => {
                let own: Vec<&Record> = records.iter().collect();
                let Some(first) = nominal(&own, (None, None))? else { return Ok(None) };
                let errors = errors(&first, &stretches(&own, &first));
                found(records, Criterion::of(&errors).sd, false)?
            }
        })
    }
}
