//! results.json.

use crate::examination::{bins_json, measure_json, share_json};
use crate::field::case::Case;
use crate::field::design::Kind;
use crate::field::scenario::Study;
use crate::field::score::{AnswerRow, Claims, Scores};
use crate::output::stamped;
use serde_json::{Value, json};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/field/1";

pub(super) fn results(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> String {
    let count = |kind: Kind| cases.iter().filter(|c| c.kind == kind).count();
    let kinds = [Kind::Planted, Kind::Outside, Kind::Bare, Kind::Resampled];
    let rigs: serde_json::Map<String, Value> =
        kinds.into_iter().map(|kind| (kind.name().to_owned(), count(kind).into())).collect();
    let mut measured: Vec<&str> = cases.iter().filter(|c| c.is_measured).map(|c| c.base.as_str()).collect();
    measured.sort_unstable();
    measured.dedup();
    let value = json!({
        "study": "field",
        "name": study.name,
        "question": study.question,
        "version": env!("CARGO_PKG_VERSION"),
        "seed": study.seed,
        "design": {
            "effects": study.effects, "sizes": study.sizes, "seeds": study.seeds, "made": study.made, "none": study.none,
            "resampled": study.resampled, "outside": study.outside, "slice": study.slice,
        },
        "measured_bases": measured,
        "key_sha256": key_sha256,
        "rigs": rigs,
        "not_observable": scores.not_observable,
        "refused": scores.refused.iter().map(|(id, why)| json!({"id": id, "why": why})).collect::<Vec<_>>(),
        "failed": scores.failed,
        "measures": scores.measures.iter().map(measure_json).collect::<Vec<_>>(),
        "by_size": rows(&scores.by_size),
        "by_planting": rows(&scores.by_planting),
        "by_effect": rows(&scores.by_effect),
        "by_base": rows(&scores.by_base),
        "calibration": claims(&scores.claims),
        "strata": scores.strata.iter().map(|s| json!({
            "of": s.of, "with_model": s.with_model, "calibration": claims(&s.claims),
        })).collect::<Vec<_>>(),
    });
    stamped(SCHEMA, &value)
}

fn rows(rows: &[AnswerRow]) -> Vec<Value> {
    let row = |row: &AnswerRow| {
        json!({
            "of": row.of, "with_model": row.with_model, "answers": row.asked, "exact": share_json(row.exact),
            "class": share_json(row.class), "silent": share_json(row.silent), "wrong": share_json(row.wrong),
        })
    };
    rows.iter().map(row).collect()
}

fn claims(claims: &Claims) -> Value {
    json!({
        "claims": claims.count, "error": claims.error, "perfect": claims.perfect, "excess": claims.excess(),
        "bins": bins_json(&claims.bins),
    })
}
