//! results.json.

use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::blind::scenario::Study;
use crate::blind::score::Scores;
use crate::examination::{bins_json, measure_json, share_json as share};
use crate::output::stamped;
use serde_json::{Value, json};

/// Name and version of the layout.
const SCHEMA: &str = "switchback/blind/1";

pub(super) fn results(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> String {
    let count = |kind: Kind| cases.iter().filter(|c| c.kind == kind).count();
    let kinds = [Kind::Single, Kind::None, Kind::Outside, Kind::Pair];
    let rigs: serde_json::Map<String, Value> =
        kinds.into_iter().map(|kind| (kind.name().to_owned(), count(kind).into())).collect();
    let value = json!({
        "study": "blind",
        "name": study.name,
        "question": study.question,
        "version": env!("CARGO_PKG_VERSION"),
        "seed": study.seed,
        "design": {
            "systems": study.systems, "sizes": study.sizes, "seeds": study.seeds, "none": study.none,
            "outside": study.outside, "pairs": study.pairs, "slice": study.slice,
        },
        "key_sha256": key_sha256,
        "rigs": rigs,
        "refused": cases.iter().filter(|c| c.reply.status == "failed").map(|c| c.id).collect::<Vec<_>>(),
        "measures": scores.measures.iter().map(measure_json).collect::<Vec<_>>(),
        "sizes": scores.sizes.iter().map(|r| json!({
            "size": r.wanted, "exact": share(r.exact), "class": share(r.class),
            "mismatch_class": share(r.mismatch_class), "wrong": share(r.wrong),
        })).collect::<Vec<_>>(),
        "calibration": {
            "ece": scores.calibration.ece, "top_ece": scores.calibration.top_ece,
            "bins": bins_json(&scores.calibration.bins),
        },
        "where": scores.places.iter().map(|p| json!({
            "axis": p.axis, "precision": p.precision, "recall": p.recall, "f1": p.f1, "cells": p.cells,
        })).collect::<Vec<_>>(),
        "closure": scores.closure.iter().map(|r| json!({
            "effect": r.effect, "rigs": r.rigs, "stated": r.stated, "actual": r.actual,
            "coverage": share(r.coverage), "error": r.error,
        })).collect::<Vec<_>>(),
        "baselines": scores.baselines.iter().map(|r| json!({
            "rule": r.rule, "exact": share(r.exact), "false_alarm": share(r.false_alarm),
            "outside_named": share(r.outside_named), "precision": share(r.precision),
        })).collect::<Vec<_>>(),
    });
    stamped(SCHEMA, &value)
}
