//! One rig after its key was opened: what was put in, what was said, and how both compare.

use super::confounded_effects::same_class;
use super::design::{Kind, Ticket};
use super::place::{PlaceCheck, check};
use crate::examination::{ClosureCheck, Evidence, Reply};
use crate::generate::{MadeRig, Nature};
use serde::{Deserialize, Serialize};
use switchback_diagnose::Diagnosis;

/// What simpler rules would have named from the same fits; none where they see no gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Baseline {
    /// The candidate that leaves the least simulation error on the hold-out records.
    pub lowest_rmse: Option<&'static str>,
    /// The candidate with the best held-out log score.
    pub heldout_winner: Option<&'static str>,
    /// The candidate with the lowest BIC.
    pub plain_bic: Option<&'static str>,
}

/// One rig, judged.
///
/// Read back only from a text that is never let go: its names are slices of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Position in the design.
    pub id: usize,
    /// What the rig is for.
    pub kind: Kind,
    /// System family.
    pub system: usize,
    /// Effects put in.
    pub truth: Vec<&'static str>,
    /// Name of the first effect's law.
    pub law: &'static str,
    /// Whether all laws are plain.
    pub plain: bool,
    /// Size asked for, of the first effect; 0 without effect.
    pub wanted: f64,
    /// Size that the rig has; of pairs the smaller of both.
    pub size: f64,
    /// What was said.
    pub reply: Reply,
    /// What simpler rules would have said.
    pub baseline: Baseline,
    /// What the verdict rests on.
    pub evidence: Evidence,
    /// How far the gap closes, where that was stated and the effects move the simulation.
    pub closure: Option<ClosureCheck>,
    /// Where, an axis at a time; only for rigs with an effect and a reply.
    pub places: Vec<PlaceCheck>,
}

/// An answer of more effects than this is no class.
const WIDEST_CLASS: usize = 3;

impl Case {
    /// Compares a diagnosis with an opened key. A rig that was refused has no diagnosis.
    pub(super) fn judge(ticket: &Ticket, diagnosis: Option<&Diagnosis>, made: &MadeRig) -> Self {
        let effects = &made.key.effects;
        let least = effects.iter().map(|e| e.size).fold(f64::INFINITY, f64::min);
        Self {
            id: ticket.id,
            kind: ticket.kind,
            system: ticket.system,
            truth: effects.iter().map(|e| e.effect).collect(),
            law: effects.first().map_or("", |e| e.law),
            plain: effects.iter().all(|e| e.plain),
            wanted: effects.first().map_or(0.0, |e| e.wanted),
            size: if effects.is_empty() { 0.0 } else { least },
            reply: diagnosis.map_or_else(Reply::refused, Reply::of),
            baseline: diagnosis.map_or(Baseline::SILENT, Baseline::of),
            evidence: diagnosis.map_or_else(Evidence::default, Evidence::of),
            closure: diagnosis.and_then(|d| closure(d, made)),
            places: match diagnosis {
                Some(d) if !effects.is_empty() => check(&d.where_, &made.rig, &made.truth),
                _ => Vec::new(),
            },
        }
    }

    /// Whether the size reached is at least 1 noise sd, as near as sizes are met.
    pub fn is_large(&self) -> bool {
        self.size >= 0.95
    }

    /// Whether exactly the effects put in are named.
    pub fn exact(&self) -> bool {
        let mut named = self.reply.effects.clone();
        let mut truth = self.truth.clone();
        named.sort_unstable();
        truth.sort_unstable();
        self.reply.status == "named" && named == truth
    }

    /// Whether one effect or one class is given and the single effect put in is that or a confounded effect of it.
    pub(crate) fn class_right(&self) -> bool {
        let [truth] = self.truth.as_slice() else { return false };
        match self.reply.status {
            "named" => matches!(self.reply.effects.as_slice(), [named] if same_class(named, truth)),
            "class" | "ambiguous" => {
                self.reply.class.len() <= WIDEST_CLASS && self.reply.class.contains(truth)
            }
            _ => false,
        }
    }

    /// Whether a cause is named, alone or as a class or rivals.
    pub(crate) fn names_a_cause(&self) -> bool {
        matches!(self.reply.status, "named" | "class" | "ambiguous")
    }

    /// Whether a confounded effect of the effect put in is given, alone or first among the rivals: nothing else in the library is as near.
    pub(crate) fn names_a_confounded(&self) -> bool {
        let given = self.reply.effects.first().or(self.reply.class.first());
        let [truth] = self.truth.as_slice() else { return false };
        self.reply.effects.len() < 2 && given.is_some_and(|given| same_class(given, truth))
    }

    /// Whether every effect named was put in.
    pub(crate) fn all_named_are_true(&self) -> bool {
        self.reply.status == "named" && self.reply.effects.iter().all(|e| self.truth.contains(e))
    }

    /// Whether the verdict, as far as it goes, holds: what its probability claims.
    pub fn verdict_holds(&self) -> bool {
        match self.reply.status {
            "none" => self.kind == Kind::None,
            "unexplained" => self.kind == Kind::Outside,
            "named" => self.exact(),
            "class" | "ambiguous" => self.truth.iter().any(|t| self.reply.class.contains(t)),
            _ => false,
        }
    }

    /// Whether the likeliest candidate is the true one.
    pub(crate) fn top_is_true(&self) -> bool {
        match self.reply.top.0 {
            "none" => self.kind == Kind::None,
            "unexplained" => self.kind == Kind::Outside,
            effect => self.truth == [effect],
        }
    }
}

impl Baseline {
    const SILENT: Self = Self { lowest_rmse: None, heldout_winner: None, plain_bic: None };

    fn of(d: &Diagnosis) -> Self {
        let best = |score: fn(&switchback_diagnose::Candidate) -> f64| {
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

/// What really closes is `1 − Σ(ȳ − ŷ_augmented)²/Σ(ȳ − ŷ_nominal)²` over the hold-out records, `ȳ` the output without noise.
fn closure(d: &Diagnosis, made: &MadeRig) -> Option<ClosureCheck> {
    let stated = d.gap.closure?;
    if made.key.effects.iter().all(|e| e.nature == Nature::Noise) {
        return None;
    }
    let (mut before, mut after) = (0.0, 0.0);
    for series in &d.series {
        let truth = made.truth.iter().find(|t| t.record == series.record)?;
        for (t, y) in truth.repeating.iter().enumerate() {
            before += (y - series.nominal.get(t)?).powi(2);
            after += (y - series.augmented.get(t)?).powi(2);
        }
    }
    (before > 0.0).then(|| ClosureCheck {
        estimate: stated.estimate,
        ci90: stated.ci90,
        actual: 1.0 - after / before,
    })
}
