//! What a diagnosis must reach in the laboratory, and what it reached.

use super::tables::{mean, of, singles};
use crate::examination::calibration::Claims;
use crate::examination::case::Case;
use crate::examination::design::Kind;
use crate::examination::measure::Bound::{AtLeast, AtMost, Within};
use crate::examination::measure::Target::{Must, Reported};
use crate::examination::measure::{Line, Reached, Target};
use crate::examination::reply::ClosureCheck;
use crate::examination::share::Share;
use crate::examination::table::Table;

/// What the measures are made of.
pub(super) struct Known<'c> {
    pub(super) cases: &'c [Case],
    pub(super) claims: &'c Claims,
    pub(super) places: &'c Table,
}

impl<'c> Known<'c> {
    /// The share of rigs of a kind.
    fn share(&self, kind: Kind, holds: impl Fn(&Case) -> bool) -> Reached {
        Reached::Share(Share::over(of(self.cases, kind), holds))
    }

    /// The share of large single effects under plain laws, or under others.
    fn large(&self, plain: bool, holds: impl Fn(&Case) -> bool) -> Reached {
        let large = singles(self.cases).filter(|case| case.is_plain() == plain && case.is_large());
        Reached::Share(Share::over(large, holds))
    }

    fn closures(&self) -> impl Iterator<Item = (&'c Case, &'c ClosureCheck)> {
        singles(self.cases).filter_map(|case| Some((case, case.answers[0].closure.as_ref()?)))
    }

    fn precision(&self) -> Reached {
        let named = self.cases.iter().filter(|c| c.kind != Kind::Outside && c.reply().status == "named");
        Reached::Share(Share::over(named, Case::all_named_are_true))
    }

    fn f1(&self) -> Reached {
        let all = self.places.rows.last();
        let cells = all.and_then(|row| row["cells"].number()).unwrap_or(0.0);
        Reached::Figure(all.and_then(|row| row["f1"].number()), cells as usize)
    }

    fn closure_error(&self) -> Reached {
        let large = || self.closures().filter(|(case, _)| case.is_large());
        Reached::Figure(mean(large().map(|(_, check)| check.error())), large().count())
    }

    fn pairs_exact(&self) -> Reached {
        Reached::Share(Share::over(of(self.cases, Kind::Pair).filter(|case| case.is_large()), Case::exact))
    }
}

/// Every measure.
pub(super) fn lines<'c>() -> [Line<Known<'c>>; 14] {
    [
        ("exact", "exact effect named, surviving gap ≥ 1 sd", Must(AtLeast(0.90)), |k| {
            k.large(true, Case::exact)
        }),
        ("class", "right class, surviving gap ≥ 1 sd", Must(AtLeast(0.95)), |k| {
            k.large(true, Case::class_right)
        }),
        ("mismatch_class", "under law mismatch, right class, ≥ 1 sd", Must(AtLeast(0.80)), |k| {
            k.large(false, Case::class_right)
        }),
        ("false_alarm", "a cause named where there is none", Must(AtMost(0.01)), |k| {
            k.share(Kind::Bare, Case::names_a_cause)
        }),
        ("precision", "of the causes named, right ones", Must(AtLeast(0.98)), Known::precision),
        ("outside_named", "effect outside the library, yet a cause named", Must(AtMost(0.05)), |k| {
            k.share(Kind::Outside, Case::names_a_cause)
        }),
        ("outside_sure", "the same, named for certain, not as one of rivals", Reported, |k| {
            k.share(Kind::Outside, |c| c.reply().status == "named")
        }),
        ("outside_no_twin", "the same, not counting a twin of what was taken out", Reported, |k| {
            k.share(Kind::Outside, |c| c.names_a_cause() && !c.names_a_confounded())
        }),
        ("ece", "calibration error of the probability (ECE)", Must(AtMost(0.03)), |k| {
            Reached::Figure(k.claims.error, k.claims.count)
        }),
        ("where_f1", "where: F1 of the cells flagged (cells counted)", Must(AtLeast(0.85)), Known::f1),
        ("coverage", "coverage of the 90 % closure interval", Must(Within(0.87, 0.93)), |k| {
            Reached::Share(Share::over(k.closures().map(|(_, check)| check), ClosureCheck::is_covered))
        }),
        ("closure_error", "mean error of the closure, ≥ 1 sd", Must(AtMost(0.05)), Known::closure_error),
        (
            "pairs_exact",
            "pairs found exactly, count unknown, each ≥ 1 sd",
            Must(AtLeast(0.85)),
            Known::pairs_exact,
        ),
        ("phantom", "phantom second effect", Must(AtMost(0.05)), |k| {
            k.share(Kind::Injected, |c| c.reply().status == "named" && c.reply().effects.len() > 1)
        }),
    ]
}

/// The keys of the measures, and how a scenario may bound each.
pub(crate) fn targets() -> Vec<(&'static str, Target)> {
    lines().iter().map(|(key, _, target, _)| (*key, *target)).collect()
}
