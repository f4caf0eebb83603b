//! What the laboratory's rigs are counted into.

use crate::examination::case::{Baseline, Case};
use crate::examination::design::Kind;
use crate::examination::place_check::PlaceCheck;
use crate::examination::reply::ClosureCheck;
use crate::examination::share::Share;
use crate::examination::table::{Cell, Table, grouped};

/// Rigs of a kind.
pub(super) fn of(cases: &[Case], kind: Kind) -> impl Iterator<Item = &Case> + Clone {
    cases.iter().filter(move |case| case.kind == kind)
}

/// Rigs with one effect of the library.
pub(super) fn singles(cases: &[Case]) -> impl Iterator<Item = &Case> + Clone {
    of(cases, Kind::Injected)
}

/// Rigs with one candidate at most; of pairs no single probability speaks.
pub(super) fn judged(cases: &[Case]) -> impl Iterator<Item = &Case> + Clone {
    cases.iter().filter(|case| case.kind != Kind::Pair && case.reply().status != "failed")
}

/// Rigs of one kind, and what they have in common.
type Group<'c, K> = (K, Vec<&'c Case>);

fn share<K>((_, cases): &Group<'_, K>, holds: impl Fn(&Case) -> bool) -> Cell {
    Cell::Share(Share::over(cases.iter().copied(), holds))
}

/// The share of those with plain laws, or of the others.
fn share_by_law<K>((_, cases): &Group<'_, K>, plain: bool, holds: impl Fn(&Case) -> bool) -> Cell {
    Cell::Share(Share::over(cases.iter().copied().filter(|case| case.is_plain() == plain), holds))
}

/// Single effects by effect, size asked for and kind of law.
pub(super) fn accuracy(cases: &[Case]) -> Table {
    // Positive numbers are in the order of their bits.
    let key = |c: &&Case| Some((c.truth()[0], !c.is_plain(), c.wanted().to_bits()));
    Table::of(
        grouped(singles(cases), key),
        &[
            ("effect", |((effect, ..), _)| Cell::word(*effect)),
            ("wanted", |((.., wanted), _)| Cell::Given(f64::from_bits(*wanted))),
            ("plain", |((_, other, _), _)| Cell::Flag(!other)),
            ("reached", |(_, cases)| {
                let sum = cases.iter().map(|case| case.size()).sum::<f64>();
                Cell::Word(format!("{:.3}", sum / cases.len() as f64))
            }),
            ("rigs", |(_, cases)| Cell::Count(cases.len())),
            ("exact", |group| share(group, Case::exact)),
            ("class", |group| share(group, Case::class_right)),
            ("none", |group| share(group, |case| case.reply().status == "none")),
            ("unexplained", |group| share(group, |case| case.reply().status == "unexplained")),
        ],
    )
}

/// Single effects by the size asked for.
pub(super) fn sizes(cases: &[Case]) -> Table {
    Table::of(
        grouped(singles(cases), |c| Some(c.wanted().to_bits())),
        &[
            ("size", |(wanted, _)| Cell::Given(f64::from_bits(*wanted))),
            ("exact", |group| share_by_law(group, true, Case::exact)),
            ("class", |group| share_by_law(group, true, Case::class_right)),
            ("mismatch_class", |group| share_by_law(group, false, Case::class_right)),
            ("wrong", |group| share(group, |case| case.names_a_cause() && !case.class_right())),
        ],
    )
}

/// What an answer costs when verdicts below a probability are withheld.
pub(super) fn abstention(cases: &[Case]) -> Table {
    let thresholds = [0.0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99];
    let rows = thresholds.map(|threshold| {
        let answers = |case: &Case| case.reply().probability >= threshold;
        let answered = judged(cases).filter(|case| answers(case));
        let right = Share::over(answered, Case::verdict_holds);
        (threshold, Share::over(judged(cases), answers), right)
    });
    Table::of(
        rows,
        &[
            ("threshold", |(threshold, ..)| Cell::Given(*threshold)),
            ("answered", |(_, answered, _)| Cell::Share(*answered)),
            ("right", |(.., right)| Cell::Share(*right)),
            ("rigs", |(.., right)| Cell::Count(right.of)),
        ],
    )
}

/// Stated closure against the closure that the stated models have, by effect, pairs together.
pub(super) fn closure(cases: &[Case]) -> Table {
    let checks = cases.iter().filter_map(|case| Some((case, case.answers[0].closure?)));
    let label = |(case, _): &(&Case, ClosureCheck)| match case.kind {
        Kind::Injected => case.truth().first().copied(),
        Kind::Pair => Some("(pairs)"),
        _ => None,
    };
    type Checks<'c> = (&'static str, Vec<(&'c Case, ClosureCheck)>);
    fn figure((_, checks): &Checks<'_>, of: fn(&ClosureCheck) -> f64) -> Cell {
        Cell::Figure(mean(checks.iter().map(|(_, check)| of(check))).unwrap_or(f64::NAN))
    }
    Table::of(
        grouped(checks, label),
        &[
            ("effect", |(effect, _)| Cell::word(*effect)),
            ("rigs", |(_, checks)| Cell::Count(checks.len())),
            ("stated", |checks| figure(checks, |c| c.estimate)),
            ("actual", |checks| figure(checks, |c| c.actual)),
            ("coverage", |(_, checks)| {
                Cell::Share(Share::over(checks.iter().map(|(_, check)| check), ClosureCheck::is_covered))
            }),
            ("error", |checks| figure(checks, ClosureCheck::error)),
        ],
    )
}

/// Mean; none of nothing.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), x| (sum + x, count + 1));
    (count > 0).then(|| sum / count as f64)
}

/// Flagged cells against those in which the effect acts, over all large single effects, an axis at a time and all together.
pub(super) fn places(cases: &[Case]) -> Table {
    let checks: Vec<&PlaceCheck> =
        singles(cases).filter(|c| c.is_large()).flat_map(|c| &c.answers[0].places).collect();
    let mut sums: Vec<PlaceCheck> = Vec::new();
    // The last one is that of all.
    for (axis, check) in checks.iter().map(|c| (c.axis, c)).chain(checks.iter().map(|c| ("all", c))) {
        let at = sums.iter().position(|sum| sum.axis == axis).unwrap_or_else(|| {
            sums.push(PlaceCheck { axis, hits: 0, false_flags: 0, misses: 0 });
            sums.len() - 1
        });
        sums[at].hits += check.hits;
        sums[at].false_flags += check.false_flags;
        sums[at].misses += check.misses;
    }
    fn ratio(part: usize, whole: usize) -> Cell {
        Cell::Figure(if whole == 0 { 0.0 } else { part as f64 / whole as f64 })
    }
    Table::of(
        sums,
        &[
            ("axis", |sum| Cell::word(sum.axis)),
            ("precision", |sum| ratio(sum.hits, sum.hits + sum.false_flags)),
            ("recall", |sum| ratio(sum.hits, sum.hits + sum.misses)),
            ("f1", |sum| ratio(2 * sum.hits, 2 * sum.hits + sum.false_flags + sum.misses)),
            ("cells", |sum| Cell::Count(sum.hits + sum.misses)),
        ],
    )
}

/// Name of a rule, and what it names.
type Rule = (&'static str, fn(&Case) -> Option<&'static str>);

fn by_rule(case: &Case, rule: fn(Baseline) -> Option<&'static str>) -> Option<&'static str> {
    case.answers[0].baseline.and_then(rule)
}

/// What the diagnosis names, as a rule that names one effect.
fn single_name(case: &Case) -> Option<&'static str> {
    match case.reply().effects[..] {
        [one] => Some(one),
        [_, ..] => Some("(several)"),
        [] => case.names_a_cause().then_some("(class)"),
    }
}

/// The diagnosis beside simpler rules on the same fits.
pub(super) fn baselines(cases: &[Case]) -> Table {
    let rules: [Rule; 4] = [
        ("this diagnosis", single_name),
        ("lowest RMSE", |case| by_rule(case, |b| b.lowest_rmse)),
        ("bare held-out winner", |case| by_rule(case, |b| b.heldout_winner)),
        ("plain BIC", |case| by_rule(case, |b| b.plain_bic)),
    ];
    let rows = rules.map(|(rule, names)| {
        let is_right = |case: &Case| names(case) == case.truth().first().copied();
        let names_any = |case: &Case| names(case).is_some();
        let single = singles(cases).filter(|case| case.is_plain() && case.is_large());
        let named = singles(cases).chain(of(cases, Kind::Bare));
        let named = named.filter(|case| names(case).is_some_and(|name| name != "(class)"));
        let shares = [
            Share::over(single, is_right),
            Share::over(of(cases, Kind::Bare), names_any),
            Share::over(of(cases, Kind::Outside), names_any),
            Share::over(named, is_right),
        ];
        (rule, shares.map(Cell::Share))
    });
    Table::of(
        rows,
        &[
            ("rule", |(rule, _)| Cell::word(*rule)),
            ("exact", |(_, [exact, ..])| exact.clone()),
            ("false_alarm", |(_, [_, alarm, ..])| alarm.clone()),
            ("outside_named", |(_, [.., outside, _])| outside.clone()),
            ("precision", |(_, [.., precision])| precision.clone()),
        ],
    )
}
