//! The records that faults are put into.

use super::{Answer, PowerError};
use crate::examination::field::{resampled, runs_of};
use crate::examination::{Reply, law, scramble};
use crate::generate::{InjectedFault, InjectedRig, InjectionContext, OBSERVABLE, Precision, RequestedFault};
use switchback_diagnose::Settings;
use switchback_io::diagnosis::{self, DiagnosisError, GivenModel, Source, Subject, SubjectError};
use switchback_model::rig::Rig;

/// A rig's records, a model of them, and how they are diagnosed.
#[derive(Debug)]
pub struct Context<'a> {
    rig: &'a Rig,
    model: Option<GivenModel>,
    settings: Settings,
    injection: InjectionContext<'a>,
    /// What the data are called in messages.
    data: String,
}

/// What became of one fault.
#[derive(Debug, Clone, PartialEq)]
pub enum Draw {
    /// It was put in and diagnosed.
    Diagnosed {
        /// The fault.
        fault: InjectedFault,
        /// What was said.
        answer: Answer,
    },
    /// It could not be put in, or not so that records can show it, for this reason.
    Refused(String),
}

/// What is random about a draw: the noise, the law, the fault's parameters.
const NOISE: u64 = 0;
const LAW: u64 = 1;
const FAULT: u64 = 2;

impl<'a> Context<'a> {
    /// Identifies what is needed; `data` is what messages call the records.
    ///
    /// # Errors
    /// [`PowerError`] where the records have predictions but no model is given, or give no model that faults can be measured against.
    pub fn new(
        rig: &'a Rig,
        model: Option<GivenModel>,
        settings: Settings,
        data: &str,
    ) -> Result<Self, PowerError> {
        let data = data.to_owned();
        if model.is_none() && rig.records.iter().any(|record| record.predicted.is_some()) {
            return Err(PowerError::Predicted { data });
        }
        if let Some(model) = &model {
            model.meet(rig.clone(), Vec::new())?;
        }
        match InjectionContext::new(rig) {
            Ok(injection) => Ok(Self { rig, model, settings, injection, data }),
            Err(error) => Err(PowerError::Context { data, error }),
        }
    }

    /// The records.
    pub fn rig(&self) -> &Rig {
        self.rig
    }

    /// Whose model is diagnosed.
    pub(crate) fn source(&self) -> Source {
        if self.model.is_some() { Source::Given } else { Source::Identified }
    }

    /// The records as the model has them, with other noise.
    fn without_fault(&self, seed: u64) -> Result<Rig, String> {
        let drawn = match &self.model {
            Some(model) => resampled(self.rig, |record| model.run(self.rig, record), seed),
            None => resampled(self.rig, runs_of(&self.injection.identified().model), seed),
        };
        drawn.map_err(|error| error.to_string())
    }

    fn diagnosed(&self, rig: Rig) -> Result<Reply, PowerError> {
        let subject: Result<Subject, SubjectError> = match &self.model {
            Some(model) => model.meet(rig, Vec::new()),
            None => Subject::choose(rig, None),
        };
        let named = |error: DiagnosisError| error.in_file(self.data.as_ref());
        Ok(Reply::of(&diagnosis::examine(subject?, &self.settings).map_err(named)?.diagnosis))
    }

    /// Diagnoses records without a fault.
    ///
    /// # Errors
    /// [`PowerError`] where these give no diagnosis: then none with a fault would.
    pub(crate) fn bare(&self, seed: u64) -> Result<Reply, PowerError> {
        let rig = self.without_fault(scramble(seed, NOISE));
        self.diagnosed(rig.map_err(|reason| PowerError::Drawn { data: self.data.clone(), reason })?)
    }

    /// Puts a fault of an effect in, of about the size asked for, and diagnoses the records.
    pub fn draw(&self, precision: Precision, (effect, size): (&'static str, f64), seed: u64) -> Draw {
        let InjectedRig { rig, fault } = match self.injected(precision, (effect, size), seed) {
            Ok(injected) => injected,
            Err(reason) => return Draw::Refused(reason),
        };
        if ![fault.magnitude, fault.size, fault.raw].iter().all(|x| x.is_finite()) {
            return Draw::Refused("no model can be identified with the fault".to_owned());
        }
        // Where ½ is asked for, a little less is reached as often as a little more.
        if !fault.is_observable() && fault.size < OBSERVABLE * size {
            return Draw::Refused(format!(
                "by the law `{}` no more than {:.2} of it survives identification anew",
                fault.law, fault.size
            ));
        }
        let reply = self.diagnosed(rig).unwrap_or_else(|_| Reply::refused());
        Draw::Diagnosed { answer: Answer::of(&reply, effect), fault }
    }

    fn injected(
        &self,
        precision: Precision,
        (effect, size): (&'static str, f64),
        seed: u64,
    ) -> Result<InjectedRig, String> {
        let reported = |error: &dyn std::fmt::Display| error.to_string();
        let base = self.without_fault(scramble(seed, NOISE))?;
        let law = law(effect, scramble(seed, LAW));
        let requested_fault = RequestedFault::with_law(effect, law, size).map_err(|e| reported(&e))?;
        let context = self.injection.with_records(&base).map_err(|e| reported(&e))?;
        context.inject_to(precision, &requested_fault, scramble(seed, FAULT)).map_err(|e| reported(&e))
    }
}
