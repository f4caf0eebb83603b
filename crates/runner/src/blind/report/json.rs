//! results.json: the same types write and read it. Keys stand in the order of the alphabet.

use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::blind::scenario::Study;
use crate::blind::score::Scores;
use crate::examination::{BinFile, MeasureFile, Partial, ShareFile};
use crate::output::stamped;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Name and version of the layout.
pub(crate) const SCHEMA: &str = "switchback/blind/1";

/// Everything a blind study found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct BlindFile {
    pub(crate) baselines: Vec<Baseline>,
    pub(crate) calibration: Calibration,
    pub(crate) closure: Vec<Closure>,
    pub(crate) design: Value,
    pub(crate) key_sha256: String,
    pub(crate) measures: Vec<MeasureFile>,
    pub(crate) name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) partial: Option<Partial>,
    pub(crate) question: String,
    /// Rigs that could not be diagnosed.
    pub(crate) refused: Vec<usize>,
    pub(crate) rigs: BTreeMap<String, usize>,
    pub(crate) seed: u64,
    pub(crate) sizes: Vec<Size>,
    pub(crate) study: String,
    pub(crate) version: String,
    pub(crate) r#where: Vec<Place>,
}

/// A rule on the same rigs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Baseline {
    pub(crate) exact: ShareFile,
    pub(crate) false_alarm: ShareFile,
    pub(crate) outside_named: ShareFile,
    pub(crate) precision: ShareFile,
    pub(crate) rule: String,
}

/// What probabilities are worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Calibration {
    pub(crate) bins: Vec<BinFile>,
    pub(crate) ece: Option<f64>,
    pub(crate) top_ece: Option<f64>,
}

/// How far the gap closes, an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Closure {
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) actual: f64,
    pub(crate) coverage: ShareFile,
    pub(crate) effect: String,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) error: f64,
    pub(crate) rigs: usize,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) stated: f64,
}

/// Answers by the size of the effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Size {
    pub(crate) class: ShareFile,
    pub(crate) exact: ShareFile,
    pub(crate) mismatch_class: ShareFile,
    pub(crate) size: f64,
    pub(crate) wrong: ShareFile,
}

/// How well places are found, an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Place {
    pub(crate) axis: String,
    pub(crate) cells: usize,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) f1: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) precision: f64,
    #[serde(deserialize_with = "crate::input::nullable::number")]
    pub(crate) recall: f64,
}

/// The object.
pub(super) fn results(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> String {
    let count = |kind: Kind| cases.iter().filter(|c| c.kind == kind).count();
    let kinds = [Kind::Single, Kind::None, Kind::Outside, Kind::Pair];
    let baseline = |r: &crate::blind::score::BaselineRow| Baseline {
        exact: r.exact.into(),
        false_alarm: r.false_alarm.into(),
        outside_named: r.outside_named.into(),
        precision: r.precision.into(),
        rule: r.rule.to_owned(),
    };
    let closure = |r: &crate::blind::score::ClosureRow| Closure {
        actual: r.actual,
        coverage: r.coverage.into(),
        effect: r.effect.to_owned(),
        error: r.error,
        rigs: r.rigs,
        stated: r.stated,
    };
    let size = |r: &crate::blind::score::SizeRow| Size {
        class: r.class.into(),
        exact: r.exact.into(),
        mismatch_class: r.mismatch_class.into(),
        size: r.wanted,
        wrong: r.wrong.into(),
    };
    let place = |p: &crate::blind::score::PlaceRow| Place {
        axis: p.axis.to_owned(),
        cells: p.cells,
        f1: p.f1,
        precision: p.precision,
        recall: p.recall,
    };
    let file = BlindFile {
        baselines: scores.baselines.iter().map(baseline).collect(),
        calibration: Calibration {
            bins: scores.calibration.bins.iter().map(BinFile::from).collect(),
            ece: scores.calibration.ece,
            top_ece: scores.calibration.top_ece,
        },
        closure: scores.closure.iter().map(closure).collect(),
        design: json!({
            "systems": study.systems, "sizes": study.sizes, "seeds": study.seeds, "none": study.none,
            "outside": study.outside, "pairs": study.pairs, "slice": study.slice,
        }),
        key_sha256: key_sha256.to_owned(),
        measures: scores.measures.iter().map(MeasureFile::from).collect(),
        name: study.name.clone(),
        partial: None,
        question: study.question.clone(),
        refused: cases.iter().filter(|c| c.reply.status == "failed").map(|c| c.id).collect(),
        rigs: kinds.into_iter().map(|kind| (kind.name().to_owned(), count(kind))).collect(),
        seed: study.seed,
        sizes: scores.sizes.iter().map(size).collect(),
        study: "blind".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        r#where: scores.places.iter().map(place).collect(),
    };
    stamped(SCHEMA, &file)
}
