//! One rig after its key was opened: what was put in, and what was said with the base's model given and without.

use super::bases::Base;
use super::design::Kind;
use super::seal::{How, Sealed};
use crate::examination::{ClosureCheck, Evidence, Reply};
use crate::generate::OBSERVABLE;
use serde::{Deserialize, Serialize};
use switchback_diagnose::{Diagnosis, Gap};

/// A fault as it was put in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// The effect.
    pub effect: &'static str,
    /// Its law.
    pub law: String,
    /// Whether that is the plain one.
    pub plain: bool,
    /// How it came in.
    pub how: How,
    /// Size asked for.
    pub wanted: f64,
    /// Size reached: what survives identification anew, over what the base's model leaves.
    pub size: f64,
    /// What the base's model newly misses.
    pub raw: f64,
}

impl Fault {
    /// Whether the records can show it at all.
    pub(crate) fn is_observable(&self) -> bool {
        self.size >= OBSERVABLE
    }

    /// Whether it reaches a size, as near as sizes are met.
    pub(crate) fn reaches(&self, size: f64) -> bool {
        self.size >= 0.95 * size
    }
}

/// One diagnosis of a rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound(deserialize = "'de: 'static"))]
pub struct Answered {
    /// Whether the base's model was given.
    pub with_model: bool,
    /// What was said.
    pub reply: Reply,
    /// What rules said before the other readings of the records were asked, where that was done.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_rules: Option<Reply>,
    /// What it rests on.
    pub evidence: Evidence,
    /// How far the gap of the model given closes, where that was stated and the fault moves the simulation. What really closes is
    /// `1 − (E(base) − s²)/(E(with the fault) − s²)`, `E` the mean square of the model's simulation error over the held-out records and `s`
    /// the noise floor that the diagnosis states: the gap and its closure are counted from there.
    pub closure: Option<ClosureCheck>,
}

impl Answered {
    /// What rules alone say.
    pub(crate) fn rules(&self) -> &Reply {
        self.by_rules.as_ref().unwrap_or(&self.reply)
    }
}

/// One rig, judged.
///
/// Read back only from a text that is never let go: its names are slices of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound(deserialize = "'de: 'static"))]
pub struct Case {
    /// Position in the design.
    pub id: usize,
    /// What the rig is for.
    pub kind: Kind,
    /// Name of its base.
    pub base: String,
    /// Whether that was measured.
    pub is_measured: bool,
    /// Effects that a made base has by itself.
    pub own: Vec<&'static str>,
    /// The fault.
    pub fault: Option<Fault>,
    /// Why there is no such rig.
    pub refused: Option<String>,
    /// What was said, without the model and with it; nothing where there is no rig.
    pub answers: Vec<Answered>,
}

impl Case {
    /// A rig with its key opened and what was said of it; `errors` are mean squares of the simulation error of the model given, without
    /// and with the fault.
    pub(super) fn judge(
        sealed: &Sealed,
        base: &Base,
        diagnoses: Vec<(bool, Option<Diagnosis>)>,
        errors: Option<[f64; 2]>,
    ) -> Self {
        let (ticket, key) = (&sealed.ticket, &sealed.key);
        let answered = |(with_model, diagnosis): (bool, Option<Diagnosis>)| {
            let check = |gap: &Gap| {
                let (stated, noise) = (gap.closure?, gap.noise_floor * gap.noise_floor);
                let [before, after] = errors.filter(|_| with_model)?.map(|error| error - noise);
                let actual = 1.0 - before / after;
                (after > 0.0).then_some(ClosureCheck { estimate: stated.estimate, ci90: stated.ci90, actual })
            };
            Answered {
                with_model,
                reply: diagnosis.as_ref().map_or_else(Reply::refused, Reply::of),
                by_rules: diagnosis.as_ref().and_then(Reply::by_rules),
                evidence: diagnosis.as_ref().map_or_else(Evidence::default, Evidence::of),
                closure: diagnosis.as_ref().and_then(|d| check(&d.gap)),
            }
        };
        // The maker puts a fault in the place of what the machine has of it by itself.
        let is_replaced = |own: &str| ticket.fault.is_some_and(|fault| fault.by_maker && fault.effect == own);
        let fault = ticket.fault.zip(key.fault.as_ref()).map(|(wanted, found)| Fault {
            effect: wanted.effect,
            law: found.law.clone(),
            plain: wanted.law == 0,
            how: found.how,
            wanted: found.wanted,
            size: found.size,
            raw: found.raw,
        });
        Self {
            id: ticket.id,
            kind: ticket.kind,
            base: base.name.clone(),
            is_measured: base.made.is_none(),
            own: base.own.iter().copied().filter(|own| !is_replaced(own)).collect(),
            fault,
            refused: key.refused.clone(),
            answers: diagnoses.into_iter().map(answered).collect(),
        }
    }
}
