//! The summary: what must be reached, what was, and what the scenario expects.

use super::calibration::Claims;
use super::rating::{Asked, Rating};
use super::rows::{RIGHT, share};
use crate::examination::{Bound, ClosureCheck, Line, Measure, Share, bounded};
use crate::field::design::Kind;
use crate::field::scenario::Expect;

/// What a diagnosis must reach.
pub(crate) const TARGETS: Expect = Expect {
    model_class: Some(0.85),
    model_exact: Some(0.70),
    class: Some(0.75),
    exact: Some(0.60),
    wrong: Some(0.05),
    false_alarm_made: Some(0.03),
    false_alarm_resampled: Some(0.03),
    outside_named: None,
    degrades_validation: Some(0.0),
    calibration: Some(0.03),
    coverage: Some([0.85, 0.95]),
};

pub(super) fn measures(asked: &[Asked<'_>], claims: &Claims, expect: &Expect) -> Vec<Measure> {
    let reported = |s: Share| (s.value(), s.interval(), s.of);
    let large =
        |with_model: bool| asked.iter().filter(move |a| a.is_large() && a.answer.with_model == with_model);
    let answered = |a: &&Asked<'_>| a.rating().is_some_and(|rating| rating != Rating::Silent);
    let named = |a: &&Asked<'_>| answered(a) && a.answer.reply.status == "named";
    let in_a_class = |a: &&Asked<'_>| answered(a) && a.answer.reply.status != "named";
    let bare_made = asked.iter().filter(|a| a.case.kind == Kind::Bare && !a.case.is_measured);
    let of = |kind: Kind| asked.iter().filter(move |a| a.case.kind == kind);
    let wrong = [Rating::Wrong];
    let closures = |is_right: bool| {
        let judged = asked.iter().filter(move |a| {
            let rating = a.rating();
            a.truth().is_some() && rating.is_some_and(|rating| !is_right || RIGHT.contains(&rating))
        });
        judged.filter_map(|a| a.answer.closure.as_ref())
    };
    let degrades_validation: Vec<bool> = asked.iter().filter_map(Asked::degrades_validation).collect();
    let lines: [Line<Expect>; 15] = [
        (
            "model_class",
            "model given: right class, size ≥ 2",
            |e| e.model_class.map(Bound::AtLeast),
            reported(share(large(true), &RIGHT)),
        ),
        (
            "model_exact",
            "model given: exact effect named, size ≥ 2",
            |e| e.model_exact.map(Bound::AtLeast),
            reported(share(large(true), &[Rating::Exact])),
        ),
        (
            "class",
            "no model given: right class, size ≥ 2",
            |e| e.class.map(Bound::AtLeast),
            reported(share(large(false), &RIGHT)),
        ),
        (
            "exact",
            "no model given: exact effect named, size ≥ 2",
            |e| e.exact.map(Bound::AtLeast),
            reported(share(large(false), &[Rating::Exact])),
        ),
        (
            "wrong",
            "of causes named for certain, wrong ones",
            |e| e.wrong.map(Bound::AtMost),
            reported(share(asked.iter().filter(named), &wrong)),
        ),
        (
            "wrong_planted",
            "the same, only where a fault of the library is",
            |_| None,
            reported(share(of(Kind::Injected).filter(named), &wrong)),
        ),
        (
            "wrong_class",
            "of all classes reported, those without the fault",
            |_| None,
            reported(share(asked.iter().filter(in_a_class), &wrong)),
        ),
        (
            "false_alarm_made",
            "made base without fault: a cause named",
            |e| e.false_alarm_made.map(Bound::AtMost),
            reported(share(bare_made, &wrong)),
        ),
        (
            "false_alarm_resampled",
            "residuals resampled: a cause not the base's own",
            |e| e.false_alarm_resampled.map(Bound::AtMost),
            reported(share(of(Kind::Resampled), &wrong)),
        ),
        (
            "outside_named",
            "foreign fault, yet a cause named",
            |e| e.outside_named.map(Bound::AtMost),
            reported(share(of(Kind::Outside), &wrong)),
        ),
        (
            "harms",
            "named although it harms a held-out record",
            |e| e.degrades_validation.map(Bound::AtMost),
            reported(Share::over(degrades_validation.iter(), |degrades_validation| *degrades_validation)),
        ),
        (
            "calibration",
            "calibration error over that of perfect claims",
            |e| e.calibration.map(Bound::AtMost),
            (claims.excess(), None, claims.count),
        ),
        ("ece", "calibration error (ECE) itself", |_| None, (claims.error, None, claims.count)),
        (
            "coverage",
            "coverage of the 90 % closure interval, model given",
            |e| e.coverage.map(|[low, high]| Bound::Within(low, high)),
            reported(Share::over(closures(false), ClosureCheck::is_covered)),
        ),
        (
            "coverage_right",
            "the same, only where the right class is reported",
            |_| None,
            reported(Share::over(closures(true), ClosureCheck::is_covered)),
        ),
    ];
    bounded(lines, (&TARGETS, expect), &["calibration", "ece"])
}
