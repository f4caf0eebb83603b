//! The summary: what must be reached, what was, and what the scenario expects.

use super::accuracy::singles;
use super::calibration::Calibration;
use super::closure;
use super::places::PlaceRow;
use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::blind::scenario::Expect;
use crate::examination::{Bound, ClosureCheck, Line, Measure, Share, bounded};

/// What a diagnosis must reach.
pub(crate) const TARGETS: Expect = Expect {
    exact: Some(0.90),
    class: Some(0.95),
    mismatch_class: Some(0.80),
    false_alarm: Some(0.01),
    precision: Some(0.98),
    outside_named: Some(0.05),
    ece: Some(0.03),
    where_f1: Some(0.85),
    coverage: Some([0.87, 0.93]),
    closure_error: Some(0.05),
    pairs_exact: Some(0.85),
    phantom: Some(0.05),
};

pub(super) fn measures(
    cases: &[Case],
    calibration: &Calibration,
    places: &[PlaceRow],
    expect: &Expect,
) -> Vec<Measure> {
    let of = |kind: Kind| cases.iter().filter(move |c| c.kind == kind);
    let plain = || singles(cases).filter(|c| c.plain && c.is_large());
    let other = || singles(cases).filter(|c| !c.plain && c.is_large());
    let named = || cases.iter().filter(|c| c.kind != Kind::Outside && c.reply.status == "named");
    let closures = || singles(cases).filter_map(|c| c.closure.as_ref());
    let large_closures = || singles(cases).filter(|c| c.is_large()).filter_map(|c| c.closure.as_ref());
    let place = places.iter().find(|p| p.axis == "all");
    let share = |s: Share| (s.value(), s.interval(), s.of);
    let two = |c: &Case| c.reply.status == "named" && c.reply.effects.len() > 1;
    let lines: [Line<Expect>; 14] = [
        (
            "exact",
            "exact effect named, surviving gap ≥ 1 sd",
            |e| e.exact.map(Bound::AtLeast),
            share(Share::over(plain(), Case::exact)),
        ),
        (
            "class",
            "right class, surviving gap ≥ 1 sd",
            |e| e.class.map(Bound::AtLeast),
            share(Share::over(plain(), Case::class_right)),
        ),
        (
            "mismatch_class",
            "under law mismatch, right class, ≥ 1 sd",
            |e| e.mismatch_class.map(Bound::AtLeast),
            share(Share::over(other(), Case::class_right)),
        ),
        (
            "false_alarm",
            "a cause named where there is none",
            |e| e.false_alarm.map(Bound::AtMost),
            share(Share::over(of(Kind::None), Case::names_a_cause)),
        ),
        (
            "precision",
            "of the causes named, right ones",
            |e| e.precision.map(Bound::AtLeast),
            share(Share::over(named(), Case::all_named_are_true)),
        ),
        (
            "outside_named",
            "effect outside the library, yet a cause named",
            |e| e.outside_named.map(Bound::AtMost),
            share(Share::over(of(Kind::Outside), Case::names_a_cause)),
        ),
        (
            "outside_sure",
            "the same, named for certain, not as one of rivals",
            |_| None,
            share(Share::over(of(Kind::Outside), |c| c.reply.status == "named")),
        ),
        (
            "outside_no_twin",
            "the same, not counting a twin of what was taken out",
            |_| None,
            share(Share::over(of(Kind::Outside), |c| c.names_a_cause() && !c.names_a_confounded())),
        ),
        (
            "ece",
            "calibration error of the probability (ECE)",
            |e| e.ece.map(Bound::AtMost),
            (calibration.ece, None, calibration.bins.iter().map(|b| b.held.of).sum()),
        ),
        (
            "where_f1",
            "where: F1 of the cells flagged (cells counted)",
            |e| e.where_f1.map(Bound::AtLeast),
            (place.map(|p| p.f1), None, place.map_or(0, |p| p.cells)),
        ),
        (
            "coverage",
            "coverage of the 90 % closure interval",
            |e| e.coverage.map(|[low, high]| Bound::Within(low, high)),
            share(closure::coverage(closures())),
        ),
        (
            "closure_error",
            "mean error of the closure, ≥ 1 sd",
            |e| e.closure_error.map(Bound::AtMost),
            (closure::mean(large_closures().map(ClosureCheck::error)), None, large_closures().count()),
        ),
        (
            "pairs_exact",
            "pairs found exactly, count unknown, each ≥ 1 sd",
            |e| e.pairs_exact.map(Bound::AtLeast),
            share(Share::over(of(Kind::Pair).filter(|c| c.is_large()), Case::exact)),
        ),
        (
            "phantom",
            "phantom second effect",
            |e| e.phantom.map(Bound::AtMost),
            share(Share::over(singles(cases), two)),
        ),
    ];
    bounded(lines, (&TARGETS, expect), &["ece", "closure_error", "where_f1"])
}
