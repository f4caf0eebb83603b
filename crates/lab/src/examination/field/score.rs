//! Scoring rigs of the field.

use super::measure::{Known, lines};
use super::tables::{answers, strata};
use crate::examination::calibration::Claims;
use crate::examination::case::Case;
use crate::examination::confusion::Confusion;
use crate::examination::design::Kind;
use crate::examination::measure::{Expect, measures};
use crate::examination::rating::{Asked, BaseVerdicts};
use crate::examination::scores::Scores;
use std::collections::BTreeMap;

/// Computes every table.
pub(crate) fn score(cases: &[Case], expect: &Expect) -> Scores {
    let asked = BaseVerdicts::of(cases).asked(cases);
    let claims = Claims::of(asked.iter().filter_map(Asked::claim));
    Scores {
        measures: measures(&lines(), &Known { asked: &asked, claims: &claims }, expect),
        confusion: confusion(&asked),
        claims,
        top_error: None,
        strata: strata(&asked),
        closures: Vec::new(),
        tables: BTreeMap::from([
            ("by_effect", answers(&asked, Asked::large_effect)),
            ("by_base", answers(&asked, |a| a.is_large().then(|| a.case.base.clone()))),
            ("by_planting", answers(&asked, |a| a.is_large().then(|| a.stratum()))),
            ("by_size", answers(&asked, Asked::size_class)),
        ]),
    }
}

/// What was put in, large faults only, against what was said beyond the base's own verdict.
fn confusion(asked: &[Asked<'_>]) -> Confusion {
    let answer = |one: &&Asked<'_>| {
        let truth = match one.case.kind {
            Kind::Injected if one.is_large() => one.truth()?,
            Kind::Injected | Kind::Pair => return None,
            Kind::Outside => "outside",
            Kind::Bare | Kind::Resampled => "none",
        };
        let said = match (one.answer.reply.status, &one.news()?[..]) {
            ("named", [effect]) => *effect,
            ("named", [_, ..]) => "several",
            ("named" | "class" | "ambiguous", []) => "none",
            (status, _) => status,
        };
        Some((truth, said))
    };
    let judged = asked.iter().filter(|a| a.rating().is_some());
    Confusion::of(judged.filter_map(|one| answer(&one)))
}
