//! Simpler rules on the same fits.

use crate::blind::case::{Baseline, Case};
use crate::blind::design::Kind;
use crate::examination::Share;

/// How one rule fares.
#[derive(Debug, Clone, PartialEq)]
pub struct BaselineRow {
    /// The rule.
    pub rule: &'static str,
    /// Plain single effects of size ≥ 1 that it names.
    pub exact: Share,
    /// Rigs without effect for which it names a cause.
    pub false_alarm: Share,
    /// Outsiders for which it names a cause.
    pub outside_named: Share,
    /// Of the causes it names in rigs with one or no effect, right ones.
    pub precision: Share,
}

/// Name of a rule, and what it names.
type Rule = (&'static str, fn(&Case) -> Option<&'static str>);

pub(super) fn rows(cases: &[Case]) -> Vec<BaselineRow> {
    fn single_name(case: &Case) -> Option<&'static str> {
        match case.reply.effects.as_slice() {
            [one] => Some(one),
            [_, ..] => Some("(several)"),
            [] if case.names_a_cause() => Some("(class)"),
            [] => None,
        }
    }
    fn rule(pick: fn(&Baseline) -> Option<&'static str>, case: &Case) -> Option<&'static str> {
        pick(&case.baseline)
    }
    let rules: [Rule; 4] = [
        ("this diagnosis", single_name),
        ("lowest RMSE", |c| rule(|b| b.lowest_rmse, c)),
        ("bare held-out winner", |c| rule(|b| b.heldout_winner, c)),
        ("plain BIC", |c| rule(|b| b.plain_bic, c)),
    ];
    let of = |kind: Kind| cases.iter().filter(move |c| c.kind == kind);
    rules
        .into_iter()
        .map(|(rule, names)| BaselineRow {
            rule,
            exact: Share::over(of(Kind::Single).filter(|c| c.plain && c.is_large()), |c| {
                names(c) == c.truth.first().copied()
            }),
            false_alarm: Share::over(of(Kind::None), |c| names(c).is_some()),
            outside_named: Share::over(of(Kind::Outside), |c| names(c).is_some()),
            precision: Share::over(
                of(Kind::Single).chain(of(Kind::None)).filter(|c| names(c).is_some_and(|n| n != "(class)")),
                |c| names(c) == c.truth.first().copied(),
            ),
        })
        .collect()
}
