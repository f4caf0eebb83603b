//! results.json: the same types write and read it. Keys stand in the order of the alphabet.

use crate::examination::{BinFile, MeasureFile, Partial, ShareFile};
use crate::field::case::Case;
use crate::field::design::Kind;
use crate::field::scenario::Study;
use crate::field::score::{AnswerRow, Claims, Scores};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use switchback_io::output::stamped;

/// Name and version of the layout.
pub const SCHEMA: &str = "switchback/field/1";

/// Everything a field examination found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FieldFile {
    /// Answers by base.
    pub by_base: Vec<Answers>,
    /// Answers by effect.
    pub by_effect: Vec<Answers>,
    /// Answers by the manner of planting.
    pub by_planting: Vec<Answers>,
    /// Answers by size.
    pub by_size: Vec<Answers>,
    /// How often claims held.
    pub calibration: Calibration,
    /// The design.
    pub design: Value,
    /// Diagnoses that were refused.
    pub failed: usize,
    /// SHA-256 of key.jsonl.
    pub key_sha256: String,
    /// Measured rigs.
    pub measured_bases: Vec<String>,
    /// The measures.
    pub measures: Vec<MeasureFile>,
    /// The scenario's name.
    pub name: String,
    /// Faults below ½.
    pub not_observable: usize,
    /// Only of an examination that was stopped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partial: Option<Partial>,
    /// What it was to answer.
    pub question: String,
    /// Rigs that could not be made.
    pub refused: Vec<Refused>,
    /// Rigs by kind.
    pub rigs: BTreeMap<String, usize>,
    /// Seed of everything.
    pub seed: u64,
    /// The same by kind of rig.
    pub strata: Vec<Stratum>,
    /// The kind of study.
    pub study: String,
    /// Version of Switchback that wrote it.
    pub version: String,
}

/// Answers of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Answers {
    /// Number of answers.
    pub answers: usize,
    /// The rivals left standing, likeliest first.
    pub class: ShareFile,
    /// Whether the records themselves were changed; else a model carried it.
    pub exact: ShareFile,
    /// Of so many.
    pub of: String,
    /// Rigs without an answer.
    pub silent: ShareFile,
    /// Whether the model of the base was given.
    pub with_model: bool,
    /// What is wrong where it fails.
    pub wrong: ShareFile,
}

/// What probabilities are worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Claimed probabilities in bins.
    pub bins: Vec<BinFile>,
    /// Number of claims.
    pub claims: usize,
    /// Expected calibration error.
    pub error: Option<f64>,
    /// Mean excess of the own squared error over the output's variance, and its 95 % interval.
    pub excess: Option<f64>,
    /// Expected calibration error of perfect probabilities on as many claims.
    pub perfect: Option<f64>,
}

/// A rig that could not be made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Refused {
    /// Number in the design.
    pub id: usize,
    /// The reason.
    pub why: String,
}

/// The calibration of a part of the rigs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stratum {
    /// How often claims held.
    pub calibration: Calibration,
    /// Of so many.
    pub of: String,
    /// Whether the model of the base was given.
    pub with_model: bool,
}

/// The object.
pub(super) fn results(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> String {
    let count = |kind: Kind| cases.iter().filter(|c| c.kind == kind).count();
    let kinds = [Kind::Injected, Kind::Outside, Kind::Bare, Kind::Resampled];
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
