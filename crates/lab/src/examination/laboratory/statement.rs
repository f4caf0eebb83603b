//! What a case of the laboratory says, and whether that holds.

use super::confounded_effects::same_class;
use crate::examination::case::Case;
use crate::examination::design::{Design, Kind};
use crate::examination::rating::WIDEST_CLASS;
use crate::examination::reply::Reply;

impl Case {
    /// What was said of a rig of the laboratory.
    pub(crate) fn reply(&self) -> &Reply {
        &self.answers[0].reply
    }

    /// The effects put in.
    pub(crate) fn truth(&self) -> Vec<&'static str> {
        self.faults().map(|fault| fault.effect).collect()
    }

    /// Whether all laws are plain.
    pub(crate) fn is_plain(&self) -> bool {
        self.faults().all(|fault| fault.plain)
    }

    /// Size asked for, of the first effect; 0 without effect.
    pub(crate) fn wanted(&self) -> f64 {
        self.fault.as_ref().map_or(0.0, |fault| fault.wanted)
    }

    /// Size that the rig has; of pairs the smaller of both.
    pub(crate) fn size(&self) -> f64 {
        self.faults().map(|fault| fault.size).reduce(f64::min).unwrap_or(0.0)
    }

    /// Whether every effect is large enough that it must be named.
    pub(crate) fn is_large(&self) -> bool {
        self.fault.is_some() && self.faults().all(|fault| fault.reaches(Design::Laboratory.large()))
    }

    /// Whether exactly the effects put in are named.
    pub(crate) fn exact(&self) -> bool {
        let (mut named, mut truth) = (self.reply().effects.clone(), self.truth());
        named.sort_unstable();
        truth.sort_unstable();
        self.reply().status == "named" && named == truth
    }

    /// Whether one effect or one class is given and the single effect put in is that or a confounded effect of it.
    pub(crate) fn class_right(&self) -> bool {
        let [truth] = self.truth()[..] else { return false };
        let Reply { status, effects, class, .. } = self.reply();
        match *status {
            "named" => matches!(effects[..], [named] if same_class(named, truth)),
            "class" | "ambiguous" => class.len() <= WIDEST_CLASS && class.contains(&truth),
            _ => false,
        }
    }

    /// Whether a cause is named, alone or as a class or rivals.
    pub(crate) fn names_a_cause(&self) -> bool {
        matches!(self.reply().status, "named" | "class" | "ambiguous")
    }

    /// Whether a confounded effect of the effect put in is given, alone or first among the rivals: nothing else in the library is as near.
    pub(crate) fn names_a_confounded(&self) -> bool {
        let Reply { effects, class, .. } = self.reply();
        let [truth] = self.truth()[..] else { return false };
        effects.len() < 2 && effects.first().or(class.first()).is_some_and(|given| same_class(given, truth))
    }

    /// Whether every effect named was put in.
    pub(crate) fn all_named_are_true(&self) -> bool {
        let truth = self.truth();
        self.reply().status == "named" && self.reply().effects.iter().all(|e| truth.contains(e))
    }

    /// Whether the verdict, as far as it goes, holds: what its probability claims.
    pub(crate) fn verdict_holds(&self) -> bool {
        match self.reply().status {
            "named" => self.exact(),
            "class" | "ambiguous" | "shortlist" => {
                self.truth().iter().any(|t| self.reply().class.contains(t))
            }
            status => self.is_rightly_silent(status),
        }
    }

    /// Whether the likeliest candidate is the true one.
    pub(crate) fn top_is_true(&self) -> bool {
        let top = self.reply().top.0;
        self.is_rightly_silent(top) || self.truth() == [top]
    }

    fn is_rightly_silent(&self, status: &str) -> bool {
        matches!((status, self.kind), ("none", Kind::Bare) | ("unexplained", Kind::Outside))
    }
}
