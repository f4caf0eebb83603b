//! What a diagnosis must reach in the field, and what it reached.

use super::tables::{RIGHT, share};
use crate::examination::calibration::Claims;
use crate::examination::design::Kind;
use crate::examination::measure::Bound::{AtLeast, AtMost, Within};
use crate::examination::measure::Target::{BoundedAbove, Must, Reported};
use crate::examination::measure::{Line, Reached, Target};
use crate::examination::rating::{Asked, Rating};
use crate::examination::reply::ClosureCheck;
use crate::examination::share::Share;

/// What the measures are made of.
pub(super) struct Known<'k> {
    pub(super) asked: &'k [Asked<'k>],
    pub(super) claims: &'k Claims,
}

impl<'k> Known<'k> {
    /// Large faults with one of some ratings.
    fn large(&self, with_model: bool, wanted: &[Rating]) -> Reached {
        let large = self.asked.iter().filter(|a| a.is_large() && a.answer.with_model == with_model);
        Reached::Share(share(large, wanted))
    }

    /// Large faults of which something holds, among those of which it can be said.
    fn of_large(&self, with_model: bool, holds: impl Fn(&Asked<'k>) -> Option<bool>) -> Reached {
        let large = self.asked.iter().filter(|a| a.is_large() && a.answer.with_model == with_model);
        let judged: Vec<bool> = large.filter_map(holds).collect();
        Reached::Share(Share::over(judged.iter(), |holds| *holds))
    }

    /// Wrong ones of the answers that something holds for.
    fn wrong(&self, is_asked: impl Fn(&Asked<'_>) -> bool) -> Reached {
        Reached::Share(share(self.asked.iter().filter(|a| is_asked(a)), &[Rating::Wrong]))
    }

    fn degrades_validation(&self) -> Reached {
        let degrades_validation: Vec<bool> =
            self.asked.iter().filter_map(Asked::degrades_validation).collect();
        Reached::Share(Share::over(degrades_validation.iter(), |degrades_validation| *degrades_validation))
    }

    /// Intervals that hold what really closes, of answers that can be judged.
    fn coverage(&self, is_asked: impl Fn(Rating) -> bool) -> Reached {
        let judged = self.asked.iter().filter(|a| a.truth().is_some() && a.rating().is_some_and(&is_asked));
        let closures = judged.filter_map(|a| a.answer.closure.as_ref());
        Reached::Share(Share::over(closures, ClosureCheck::is_covered))
    }
}

/// Whether causes are reported, for certain or not.
fn shows(asked: &Asked<'_>, certain: bool) -> bool {
    let is_answered = asked.rating().is_some_and(|rating| rating != Rating::Silent);
    is_answered && (asked.answer.reply.status == "named") == certain
}

/// Every measure.
pub(super) fn lines<'k>() -> [Line<Known<'k>>; 19] {
    [
        ("model_class", "model given: right class, size ≥ 2", Must(AtLeast(0.85)), |k| {
            k.large(true, &RIGHT)
        }),
        ("model_exact", "model given: exact effect named, size ≥ 2", Must(AtLeast(0.70)), |k| {
            k.large(true, &[Rating::Exact])
        }),
        ("class", "no model given: right class, size ≥ 2", Must(AtLeast(0.75)), |k| k.large(false, &RIGHT)),
        ("exact", "no model given: exact effect named, size ≥ 2", Must(AtLeast(0.60)), |k| {
            k.large(false, &[Rating::Exact])
        }),
        ("model_guess", "model given: likeliest of the right class", Must(AtLeast(0.75)), |k| {
            k.of_large(true, Asked::is_guessed)
        }),
        ("guess", "no model given: likeliest of the right class", Must(AtLeast(0.60)), |k| {
            k.of_large(false, Asked::is_guessed)
        }),
        ("model_listed", "model given: not named, but listed among three", Must(AtLeast(0.85)), |k| {
            k.of_large(true, Asked::is_listed)
        }),
        ("listed", "no model given: not named, but listed among three", Must(AtLeast(0.75)), |k| {
            k.of_large(false, Asked::is_listed)
        }),
        ("wrong", "of causes named for certain, wrong ones", Must(AtMost(0.05)), |k| {
            k.wrong(|a| shows(a, true))
        }),
        ("wrong_planted", "the same, only where a fault of the library is", Reported, |k| {
            k.wrong(|a| a.case.kind == Kind::Injected && shows(a, true))
        }),
        ("wrong_class", "of all classes reported, those without the fault", Reported, |k| {
            k.wrong(|a| shows(a, false))
        }),
        ("false_alarm_made", "made base without fault: a cause named", Must(AtMost(0.03)), |k| {
            k.wrong(|a| a.case.kind == Kind::Bare && !a.case.is_measured)
        }),
        (
            "false_alarm_resampled",
            "residuals resampled: a cause not the base's own",
            Must(AtMost(0.03)),
            |k| k.wrong(|a| a.case.kind == Kind::Resampled),
        ),
        ("outside_named", "foreign fault, yet a cause named", BoundedAbove, |k| {
            k.wrong(|a| a.case.kind == Kind::Outside)
        }),
        ("harms", "named although it harms a held-out record", Must(AtMost(0.0)), Known::degrades_validation),
        ("calibration", "calibration error over that of perfect claims", Must(AtMost(0.03)), |k| {
            Reached::Figure(k.claims.excess, k.claims.count)
        }),
        ("ece", "calibration error (ECE) itself", Reported, |k| {
            Reached::Figure(k.claims.error, k.claims.count)
        }),
        ("coverage", "coverage of the 90 % closure interval, model given", Must(Within(0.85, 0.95)), |k| {
            k.coverage(|_| true)
        }),
        ("coverage_right", "the same, only where the right class is reported", Reported, |k| {
            k.coverage(|rating| RIGHT.contains(&rating))
        }),
    ]
}

/// The keys of the measures, and how a scenario may bound each.
pub(crate) fn targets() -> Vec<(&'static str, Target)> {
    lines().iter().map(|(key, _, target, _)| (*key, *target)).collect()
}
