//! results.json: the same types write and read it. Keys stand in the order of the alphabet.

use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::blind::scenario::Study;
use crate::blind::score::Scores;
use crate::examination::{BinFile, MeasureFile, Partial, ShareFile};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use switchback_io::output::stamped;

/// Name and version of the layout.
pub const SCHEMA: &str = "switchback/blind/1";

/// Everything a blind study found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BlindFile {
    /// Simpler rules.
    pub baselines: Vec<Baseline>,
    /// How often claims held.
    pub calibration: Calibration,
    /// Closure by effect.
    pub closure: Vec<Closure>,
    /// The design.
    pub design: Value,
    /// SHA-256 of key.jsonl.
    pub key_sha256: String,
    /// The measures.
    pub measures: Vec<MeasureFile>,
    /// The scenario's name.
    pub name: String,
    /// Only of an examination that was stopped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partial: Option<Partial>,
    /// What it was to answer.
    pub question: String,
    /// Rigs that could not be diagnosed.
    pub refused: Vec<usize>,
    /// Rigs by kind.
    pub rigs: BTreeMap<String, usize>,
    /// Seed of everything.
    pub seed: u64,
    /// By the size asked for.
    pub sizes: Vec<Size>,
    /// The kind of study.
    pub study: String,
    /// Version of Switchback that wrote it.
    pub version: String,
    /// Localisation by axis.
    pub r#where: Vec<Place>,
}

/// A rule on the same rigs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// Whether the records themselves were changed; else a model carried it.
    pub exact: ShareFile,
    /// Probability that a check fails though nothing is wrong.
    pub false_alarm: ShareFile,
    /// Effects outside the library that were given a name.
    pub outside_named: ShareFile,
    /// The precision asked for, a share of u_M − u_m.
    pub precision: ShareFile,
    /// What counts as a reversal, input units.
    pub rule: String,
}

/// What probabilities are worth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Claimed probabilities in bins.
    pub bins: Vec<BinFile>,
    /// Expected calibration error.
    pub ece: Option<f64>,
    /// Expected calibration error of the most probable candidate.
    pub top_ece: Option<f64>,
}

/// How far the gap closes, an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Closure {
    /// Share of the gap that the models really close.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub actual: f64,
    /// Coverage of 95 % intervals at the largest N.
    pub coverage: ShareFile,
    /// The effect.
    pub effect: String,
    /// Stated minus actual closure.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub error: f64,
    /// Rigs by kind.
    pub rigs: usize,
    /// Stated closure.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub stated: f64,
}

/// Answers by the size of the effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Size {
    /// The rivals left standing, likeliest first.
    pub class: ShareFile,
    /// Whether the records themselves were changed; else a model carried it.
    pub exact: ShareFile,
    /// Right class where the law differs from that of the library.
    pub mismatch_class: ShareFile,
    /// Size of all effects together.
    pub size: f64,
    /// What is wrong where it fails.
    pub wrong: ShareFile,
}

/// How well places are found, an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// What the map runs over.
    pub axis: String,
    /// One entry a cell: case × border × method × m × noise × N.
    pub cells: usize,
    /// Harmonic mean of precision and recall.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub f1: f64,
    /// The precision asked for, a share of u_M − u_m.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub precision: f64,
    /// Share of the flagged cells among the true ones.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub recall: f64,
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
