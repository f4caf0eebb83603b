//! Scoring rigs of the laboratory.

use super::measure::{Known, lines};
use super::tables::{abstention, accuracy, baselines, closure, judged, places, sizes};
use crate::examination::calibration::{Claims, calibration_bins, calibration_error};
use crate::examination::case::Case;
use crate::examination::confusion::Confusion;
use crate::examination::design::Kind;
use crate::examination::measure::{Expect, measures};
use crate::examination::scores::Scores;
use std::collections::BTreeMap;

/// Computes every table.
pub(crate) fn score(cases: &[Case], expect: &Expect) -> Scores {
    let claims = Claims::of(judged(cases).map(|c| (c.reply().probability, c.verdict_holds())));
    let tops: Vec<(f64, bool)> = judged(cases).map(|c| (c.reply().top.1, c.top_is_true())).collect();
    let places = places(cases);
    Scores {
        measures: measures(&lines(), &Known { cases, claims: &claims, places: &places }, expect),
        confusion: confusion(cases),
        claims,
        top_error: calibration_error(&calibration_bins(&tops)),
        strata: Vec::new(),
        closures: cases.iter().filter_map(|c| Some((c.is_large(), c.answers[0].closure?))).collect(),
        tables: BTreeMap::from([
            ("accuracy", accuracy(cases)),
            ("sizes", sizes(cases)),
            ("abstention", abstention(cases)),
            ("closure", closure(cases)),
            ("where", places),
            ("baselines", baselines(cases)),
        ]),
    }
}

fn confusion(cases: &[Case]) -> Confusion {
    let answer = |case: &Case| {
        let truth = match case.kind {
            Kind::Injected if case.is_large() => case.truth()[0],
            Kind::Bare => "none",
            Kind::Outside => "outside",
            Kind::Injected | Kind::Pair | Kind::Resampled => return None,
        };
        let said = match (case.reply().status, &case.reply().effects[..]) {
            ("named", [one]) => one,
            ("named", _) => "several",
            (status, _) => status,
        };
        Some((truth, said))
    };
    Confusion::of(cases.iter().filter_map(answer))
}
