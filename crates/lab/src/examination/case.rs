//! One rig after its key was opened: what was put in, and what was said of it.

use super::design::Kind;
use super::fault::Fault;
use super::place_check::PlaceCheck;
use super::reply::{ClosureCheck, Evidence, Reply};
use serde::{Deserialize, Serialize};
use switchback_diagnose::{Candidate, Diagnosis};

/// What simpler rules would have named from the same fits; none where they see no gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Baseline {
    /// The candidate that leaves the least simulation error on the hold-out records.
    pub lowest_rmse: Option<&'static str>,
    /// The candidate with the best held-out log score.
    pub heldout_winner: Option<&'static str>,
    /// The candidate with the lowest BIC.
    pub plain_bic: Option<&'static str>,
}

impl Baseline {
    /// What they would have named.
    pub(crate) fn of(d: &Diagnosis) -> Self {
        let best = |score: fn(&Candidate) -> f64| {
            let scored = d.candidates.iter().map(|c| (c.effect.name(), score(c)));
            scored.filter(|(_, s)| *s > 0.0).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(name, _)| name)
        };
        Self {
            lowest_rmse: best(|c| c.closure.unwrap_or(0.0)),
            heldout_winner: best(|c| c.heldout_log_score),
            plain_bic: best(|c| c.delta_bic),
        }
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
    /// What it rests on.
    pub evidence: Evidence,
    /// How far the gap closes, where that was stated and what was put in moves the simulation. In the field the gap is that of the model
    /// given, and what really closes is `1 − (E(base) − s²)/(E(with the fault) − s²)`, `E` the mean square of the model's simulation error
    /// over the held-out records and `s` the noise floor that the diagnosis states: the gap and its closure are counted from there.
    pub closure: Option<ClosureCheck>,
    /// What simpler rules would have said, in the laboratory.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<Baseline>,
    /// Where, an axis at a time; only for rigs of the laboratory with an effect and a reply.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<PlaceCheck>,
}

impl Answered {
    /// What was said; a rig that was refused has no diagnosis.
    pub(crate) fn of(with_model: bool, diagnosis: Option<&Diagnosis>) -> Self {
        Self {
            with_model,
            reply: diagnosis.map_or_else(Reply::refused, Reply::of),
            evidence: diagnosis.map_or_else(Evidence::default, Evidence::of),
            closure: None,
            baseline: None,
            places: Vec::new(),
        }
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
    /// Name of its base; in the laboratory the number of its family of systems.
    pub base: String,
    /// Whether that was measured.
    pub is_measured: bool,
    /// Effects that a made base has by itself.
    pub own: Vec<&'static str>,
    /// The effect put in.
    pub fault: Option<Fault>,
    /// The other one of a pair.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second: Option<Fault>,
    /// Why there is no such rig.
    pub refused: Option<String>,
    /// What was said, in the field without the model and with it; nothing where there is no rig.
    pub answers: Vec<Answered>,
}

impl Case {
    /// What was put in.
    pub(crate) fn faults(&self) -> impl Iterator<Item = &Fault> {
        self.fault.iter().chain(&self.second)
    }
}
