//! results.json: the same types write and read it. Keys stand in the order of the alphabet.

use crate::examination::{BinFile, MeasureFile, Partial, ShareFile};
use crate::field::case::Case;
use crate::field::design::Kind;
use crate::field::scenario::Study;
use crate::field::score::{AnswerRow, Claims, Scores};
use crate::output::stamped;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Name and version of the layout.
pub(crate) const SCHEMA: &str = "switchback/field/1";

/// Everything a field examination found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct FieldFile {
    pub(crate) by_base: Vec<Answers>,
    pub(crate) by_effect: Vec<Answers>,
    pub(crate) by_planting: Vec<Answers>,
    pub(crate) by_size: Vec<Answers>,
    pub(crate) calibration: Calibration,
    pub(crate) design: Value,
    /// Diagnoses that were refused.
    pub(crate) failed: usize,
    pub(crate) key_sha256: String,
    pub(crate) measured_bases: Vec<String>,
    pub(crate) measures: Vec<MeasureFile>,
    pub(crate) name: String,
    pub(crate) not_observable: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) partial: Option<Partial>,
    pub(crate) question: String,
    pub(crate) refused: Vec<Refused>,
    pub(crate) rigs: BTreeMap<String, usize>,
    pub(crate) seed: u64,
    pub(crate) strata: Vec<Stratum>,
    pub(crate) study: String,
    pub(crate) version: String,
}

/// Answers of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Answers {
    pub(crate) answers: usize,
    pub(crate) class: ShareFile,
    pub(crate) exact: ShareFile,
    pub(crate) of: String,
    pub(crate) silent: ShareFile,
    pub(crate) with_model: bool,
    pub(crate) wrong: ShareFile,
}

/// What probabilities are worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Calibration {
    pub(crate) bins: Vec<BinFile>,
    pub(crate) claims: usize,
    pub(crate) error: Option<f64>,
    pub(crate) excess: Option<f64>,
    pub(crate) perfect: Option<f64>,
}

/// A rig that could not be made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Refused {
    pub(crate) id: usize,
    pub(crate) why: String,
}

/// The calibration of a part of the rigs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Stratum {
    pub(crate) calibration: Calibration,
    pub(crate) of: String,
    pub(crate) with_model: bool,
}

/// The object.
pub(super) fn results(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> String {
    let count = |kind: Kind| cases.iter().filter(|c| c.kind == kind).count();
    let kinds = [Kind::Planted, Kind::Outside, Kind::Bare, Kind::Resampled];
    let mut measured: Vec<String> = cases.iter().filter(|c| c.is_measured).map(|c| c.base.clone()).collect();
    measured.sort_unstable();
    measured.dedup();
    let stratum = |s: &crate::field::score::Stratum| Stratum {
        calibration: Calibration::from(&s.claims),
        of: s.of.clone(),
        with_model: s.with_model,
    };
    let file = FieldFile {
        by_base: rows(&scores.by_base),
        by_effect: rows(&scores.by_effect),
        by_planting: rows(&scores.by_planting),
        by_size: rows(&scores.by_size),
        calibration: Calibration::from(&scores.claims),
        design: json!({
            "effects": study.effects, "sizes": study.sizes, "seeds": study.seeds, "made": study.made, "none": study.none,
            "resampled": study.resampled, "outside": study.outside, "slice": study.slice,
        }),
        failed: scores.failed,
        key_sha256: key_sha256.to_owned(),
        measured_bases: measured,
        measures: scores.measures.iter().map(MeasureFile::from).collect(),
        name: study.name.clone(),
        not_observable: scores.not_observable,
        partial: None,
        question: study.question.clone(),
        refused: scores.refused.iter().map(|(id, why)| Refused { id: *id, why: why.clone() }).collect(),
        rigs: kinds.into_iter().map(|kind| (kind.name().to_owned(), count(kind))).collect(),
        seed: study.seed,
        strata: scores.strata.iter().map(stratum).collect(),
        study: "field".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    stamped(SCHEMA, &file)
}

fn rows(rows: &[AnswerRow]) -> Vec<Answers> {
    let row = |row: &AnswerRow| Answers {
        answers: row.asked,
        class: row.class.into(),
        exact: row.exact.into(),
        of: row.of.clone(),
        silent: row.silent.into(),
        with_model: row.with_model,
        wrong: row.wrong.into(),
    };
    rows.iter().map(row).collect()
}

impl From<&Claims> for Calibration {
    fn from(claims: &Claims) -> Self {
        Self {
            bins: claims.bins.iter().map(BinFile::from).collect(),
            claims: claims.count,
            error: claims.error,
            excess: claims.excess(),
            perfect: claims.perfect,
        }
    }
}
