//! What a diagnosis said, and on what evidence, as plain data that lasts.

use serde::{Deserialize, Serialize};
use switchback_diagnose::posterior::Classification;
use switchback_diagnose::{Compared, Diagnosis, Effect, Status, Together, Verdict};

/// What a diagnosis said, in the words of its JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reply {
    /// `none`, `named`, `class`, `ambiguous`, `unexplained`, or `failed` where the rig was refused.
    pub status: &'static str,
    /// Effects named; empty unless `named`.
    pub effects: Vec<&'static str>,
    /// Effects left standing (`class`, `ambiguous`).
    pub class: Vec<&'static str>,
    /// Stage pointed at.
    pub stage: Option<&'static str>,
    /// Probability that the verdict holds.
    pub probability: f64,
    /// The likeliest candidate (an effect, `none` or `unexplained`) and its probability.
    pub top: (&'static str, f64),
}

impl Reply {
    /// The reply where a rig was refused.
    pub(crate) fn refused() -> Self {
        let (effects, class) = (Vec::new(), Vec::new());
        Self { status: "failed", effects, class, stage: None, probability: 0.0, top: ("failed", 0.0) }
    }

    /// The effects that it points at.
    pub(crate) fn said(&self) -> &[&'static str] {
        match self.status {
            "named" => &self.effects,
            "class" | "ambiguous" => &self.class,
            _ => &[],
        }
    }

    /// What a diagnosis said.
    pub(crate) fn of(d: &Diagnosis) -> Self {
        Self::reported(&d.verdict, Self::top(d))
    }

    fn top(d: &Diagnosis) -> (&'static str, f64) {
        let fitted = || d.candidates.iter().map(|c| (c.effect, c.probability)).collect();
        let effects = d.classification.as_ref().map_or_else(fitted, Classification::effects);
        likeliest(effects, [d.probability_none, d.probability_unexplained])
    }

    /// The effects that it lists, whether or not it points at them.
    pub(crate) fn listed(&self) -> &[&'static str] {
        if self.status == "shortlist" { &self.class } else { self.said() }
    }

    /// A verdict, with the likeliest candidate.
    pub(crate) fn reported(verdict: &Verdict, top: (&'static str, f64)) -> Self {
        let named = if verdict.status == Status::Named { verdict.effects.as_slice() } else { &[] };
        Self {
            status: verdict.status.name(),
            effects: named.iter().map(|e| e.name()).collect(),
            class: verdict.class.iter().map(|e| e.name()).collect(),
            stage: verdict.stage.map(|s| s.name()),
            probability: verdict.probability,
            top,
        }
    }
}

fn likeliest(effects: Vec<(Effect, f64)>, [none, unexplained]: [f64; 2]) -> (&'static str, f64) {
    let rest = [("none", none), ("unexplained", unexplained)];
    let all = effects.iter().map(|(effect, p)| (effect.name(), *p)).chain(rest);
    all.fold(("failed", 0.0), |best, x| if x.1 > best.1 { x } else { best })
}

/// What the fits left and gained.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(bound(deserialize = "'de: 'static"))]
pub struct Evidence {
    /// Deviance that causes in general would still gain.
    pub left: f64,
    /// Best candidates: effect, gain in penalised deviance, held-out gain in nats a sample, held-out closure.
    pub candidates: Vec<(&'static str, f64, f64, Option<f64>)>,
    /// Samples fitted.
    pub samples: usize,
    /// The best pair of effects, where one was looked for.
    pub together: Option<PairEvidence>,
    /// What the records say of every effect that was fitted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub compared: Vec<Compared>,
}

/// What the best pair of effects gained and left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(bound(deserialize = "'de: 'static"))]
pub struct PairEvidence {
    /// Both effects.
    pub effects: Vec<&'static str>,
    /// Penalised deviance gained over the best single effect.
    pub gain: f64,
    /// Deviance that causes in general would still gain beside the pair.
    pub left: f64,
    /// The same beside the best single effect.
    pub left_by_single: f64,
}

impl PairEvidence {
    fn of(pair: &Together) -> Self {
        Self {
            effects: pair.effects.iter().map(|e| e.name()).collect(),
            gain: pair.gain,
            left: pair.left,
            left_by_single: pair.left_by_single,
        }
    }
}

impl Evidence {
    /// Candidates kept.
    const KEPT: usize = 4;

    /// `effect:ΔBIC:nats:closure` of the best candidates, as a field of a table.
    pub(crate) fn gains(&self) -> String {
        let one = |&(effect, gain, nats, closure): &(&str, f64, f64, Option<f64>)| {
            let closure = closure.map_or_else(String::new, |c| format!("{c:.3}"));
            format!("{effect}:{gain:.0}:{nats:.4}:{closure}")
        };
        self.candidates.iter().map(one).collect::<Vec<_>>().join("|")
    }

    /// What a diagnosis rests on.
    pub(crate) fn of(d: &Diagnosis) -> Self {
        let mut candidates: Vec<_> = d
            .candidates
            .iter()
            .map(|c| (c.effect.name(), c.delta_bic, c.heldout_log_score, c.closure))
            .collect();
        candidates.sort_by(|x, y| y.1.total_cmp(&x.1));
        candidates.truncate(Self::KEPT);
        Self {
            left: d.left,
            candidates,
            samples: d.samples,
            together: d.together.as_ref().map(PairEvidence::of),
            compared: d.evidence.iter().cloned().collect(),
        }
    }
}

/// The closure stated against the closure that the stated models really have.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClosureCheck {
    /// Stated.
    pub estimate: f64,
    /// Stated 90 % interval.
    pub ci90: [f64; 2],
    /// What really closes; each examination says how that is known.
    pub actual: f64,
}

impl ClosureCheck {
    /// Whether the interval holds what really closes.
    pub(crate) fn is_covered(&self) -> bool {
        (self.ci90[0]..=self.ci90[1]).contains(&self.actual)
    }

    /// Distance of what was stated from what really closes.
    pub(crate) fn error(&self) -> f64 {
        (self.estimate - self.actual).abs()
    }
}
