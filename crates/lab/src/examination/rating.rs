//! What an answer in the field is worth.

use super::case::{Answered, Case};
use super::design::{Kind, LARGE};
use super::laboratory::same_class;
use std::collections::HashMap;

/// What an answer names beyond what the base shows by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Rating {
    /// The fault, and nothing else.
    Exact,
    /// A class of at most three with the fault, or only confounded effects of it.
    Class,
    /// Nothing.
    Silent,
    /// Anything else.
    Wrong,
}

impl Rating {
    /// The name in tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Class => "class",
            Self::Silent => "silent",
            Self::Wrong => "wrong",
        }
    }
}

/// An answer of more effects than this is no class.
pub(crate) const WIDEST_CLASS: usize = 3;

/// What measured bases show by themselves, with their model given and without.
#[derive(Debug)]
pub(crate) struct BaseVerdicts<'c>(HashMap<(&'c str, bool), &'c [&'static str]>);

impl<'c> BaseVerdicts<'c> {
    /// Those among some cases.
    pub(crate) fn of(cases: &'c [Case]) -> Self {
        let bare = cases.iter().filter(|c| c.kind == Kind::Bare && c.is_measured);
        let verdicts = bare.flat_map(|c| {
            c.answers.iter().map(|answer| ((c.base.as_str(), answer.with_model), answer.reply.said()))
        });
        Self(verdicts.collect())
    }

    /// Every answer with what its base shows by itself.
    pub(crate) fn asked(&self, cases: &'c [Case]) -> Vec<Asked<'c>> {
        let one = |case: &'c Case| {
            let own = |with_model: bool| match case.is_measured {
                true => self.0.get(&(case.base.as_str(), with_model)).copied(),
                false => Some(case.own.as_slice()),
            };
            case.answers.iter().map(move |answer| Asked { case, answer, own: own(answer.with_model) })
        };
        cases.iter().flat_map(one).collect()
    }
}

/// One answer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked<'c> {
    /// The rig.
    pub case: &'c Case,
    /// What was said of it.
    pub answer: &'c Answered,
    /// What the base shows by itself; none where that is not known.
    own: Option<&'c [&'static str]>,
}

impl<'c> Asked<'c> {
    /// What is named beyond what the base shows by itself.
    pub(crate) fn news(&self) -> Option<Vec<&'static str>> {
        let own = self.own?;
        Some(self.answer.reply.said().iter().copied().filter(|effect| !own.contains(effect)).collect())
    }

    /// The effect put in, where the library has it.
    pub(crate) fn truth(&self) -> Option<&'static str> {
        let fault = self.case.fault.as_ref().filter(|_| self.case.kind == Kind::Injected)?;
        Some(fault.effect)
    }

    /// What the answer is worth. None where nobody can show: a measured base as it is, one whose own verdict is not known, a fault that the
    /// base shows by itself, and one too small to be asked for.
    pub(crate) fn rating(&self) -> Option<Rating> {
        let news = self.news()?;
        let is_reported_by_base =
            self.truth().is_some_and(|truth| self.own.unwrap_or_default().contains(&truth));
        let is_unobservable = self.case.fault.as_ref().is_some_and(|fault| !fault.is_observable());
        if is_reported_by_base || is_unobservable || (self.case.kind == Kind::Bare && self.case.is_measured) {
            return None;
        }
        if news.is_empty() {
            return Some(Rating::Silent);
        }
        let Some(truth) = self.truth() else { return Some(Rating::Wrong) };
        let is_class = self.answer.reply.said().len() <= WIDEST_CLASS;
        let are_confounded_effects = news.iter().all(|effect| same_class(effect, truth));
        Some(match self.answer.reply.status {
            "named" if news == [truth] => Rating::Exact,
            "named" if are_confounded_effects => Rating::Class,
            "class" | "ambiguous" if is_class && (are_confounded_effects || news.contains(&truth)) => {
                Rating::Class
            }
            _ => Rating::Wrong,
        })
    }

    /// Whether the likeliest candidate is the fault or confounded with it; none where nobody can show.
    pub(crate) fn is_guessed(&self) -> Option<bool> {
        let truth = self.truth().filter(|_| self.rating().is_some())?;
        Some(same_class(self.answer.reply.top.0, truth))
    }

    /// Whether the effects listed hold a fault that is not named; none where one effect is named, or nobody can show.
    pub(crate) fn is_listed(&self) -> Option<bool> {
        let reply = &self.answer.reply;
        let truth = self.truth().filter(|_| self.rating().is_some() && reply.status != "named")?;
        Some(reply.listed().len() <= WIDEST_CLASS && reply.listed().contains(&truth))
    }

    /// The probability claimed and whether what it claims holds; none where nobody can show, as where only what the base shows by itself
    /// is named.
    pub(crate) fn claim(&self) -> Option<(f64, bool)> {
        let rating = self.rating()?;
        let only_own = rating == Rating::Silent && !self.answer.reply.said().is_empty();
        if only_own || self.answer.reply.status == "failed" {
            return None;
        }
        let holds = match self.answer.reply.status {
            "none" | "refit" | "parameters" => self.case.fault.is_none(),
            "unexplained" => self.case.kind == Kind::Outside,
            "named" => rating == Rating::Exact,
            // That the cause is among these.
            "class" | "ambiguous" | "shortlist" => {
                self.truth().is_some_and(|truth| self.answer.reply.listed().contains(&truth))
            }
            _ => false,
        };
        Some((self.answer.reply.probability, holds))
    }

    /// Whether the one effect named makes a held-out record worse beyond its error; none where not one is named.
    pub(crate) fn degrades_validation(&self) -> Option<bool> {
        let [named] = self.answer.reply.effects[..] else { return None };
        let effects = &self.answer.evidence.compared.first()?.effects;
        effects.iter().find(|known| known.effect.name() == named).map(|known| known.degrades_validation)
    }

    /// Whether a fault of the library is large enough that it must be named.
    pub(crate) fn is_large(&self) -> bool {
        self.truth().is_some() && self.case.fault.as_ref().is_some_and(|fault| fault.reaches(LARGE))
    }

    /// The effect of a large fault.
    pub(crate) fn large_effect(&self) -> Option<String> {
        self.truth().filter(|_| self.is_large()).map(str::to_owned)
    }

    /// The size reached by a fault of the library, in classes.
    pub(crate) fn size_class(&self) -> Option<String> {
        let fault = self.case.fault.as_ref().filter(|_| self.truth().is_some())?;
        let classes = [(4.0, "4 or more"), (LARGE, "2 to 4"), (1.0, "1 to 2")];
        let class = classes.into_iter().find(|(size, _)| fault.reaches(*size)).map(|(_, class)| class);
        let below = if fault.is_observable() { "½ to 1" } else { "below ½: not observable" };
        Some(class.unwrap_or(below).to_owned())
    }

    /// Measured or made, and how the fault came in.
    pub(crate) fn stratum(&self) -> String {
        let base = if self.case.is_measured { "measured" } else { "made" };
        match (&self.case.fault, self.case.kind) {
            (Some(fault), Kind::Outside) => format!("{base}, foreign, {}", fault.how.name()),
            (Some(fault), _) => format!("{base}, {}", fault.how.name()),
            (None, _) => format!("{base}, no fault"),
        }
    }
}
