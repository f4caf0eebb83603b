//! results.json: the same type writes and reads it.

use super::calibration::Stratum;
use super::case::Case;
use super::design::Design;
use super::measure::Measure;
use super::scenario::Study;
use super::scores::Scores;
use super::table::Table;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use switchback_io::output::stamped;

/// Everything that an examination found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Name and version of the layout.
    #[serde(skip_serializing)]
    pub schema: String,
    /// How often claims held.
    pub calibration: Value,
    /// The design.
    pub design: Value,
    /// Field: diagnoses that were refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<usize>,
    /// SHA-256 of key.jsonl.
    pub key_sha256: String,
    /// Field: measured bases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured_bases: Option<BTreeSet<String>>,
    /// The measures.
    pub measures: Vec<Measure>,
    /// The scenario's name.
    pub name: String,
    /// Field: faults below ½.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_observable: Option<usize>,
    /// Only of an examination that was stopped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub partial: Option<Partial>,
    /// What it was to answer.
    pub question: String,
    /// Rigs without a diagnosis: in the laboratory those that were refused, in the field those that could not be made.
    pub refused: Vec<Refused>,
    /// Rigs by kind.
    pub rigs: BTreeMap<String, usize>,
    /// Seed of everything.
    pub seed: u64,
    /// Field: the claims a stratum at a time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strata: Option<Vec<Stratum>>,
    /// The kind of study.
    pub study: String,
    /// Version of Switchback that wrote it.
    pub version: String,
    /// What answers are counted into, by name.
    #[serde(flatten)]
    pub tables: BTreeMap<String, Table>,
}

/// A rig without a diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Refused {
    /// By its number in the design.
    Rig(usize),
    /// The same, and why.
    Reported {
        /// Number in the design.
        id: usize,
        /// The reason.
        why: String,
    },
}

/// Not all rigs of an examination.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Partial {
    /// Rigs that were judged.
    pub rigs: usize,
    /// … of so many.
    pub of: usize,
}

impl fmt::Display for Partial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PARTIAL: the examination was stopped after {} of {} rigs.", self.rigs, self.of)
    }
}

/// Tables that are written as CSV alone.
const NOT_HERE: [&str; 2] = ["accuracy", "abstention"];

impl Results {
    /// What was found in some cases.
    pub(crate) fn of(study: &Study, key_sha256: &str, cases: &[Case], scores: &Scores) -> Self {
        let is_field = study.design == Design::Field;
        let tables = scores.tables.iter().filter(|(name, _)| !NOT_HERE.contains(name));
        let kinds = study.design.kinds().into_iter();
        let count = |kind| cases.iter().filter(|case| case.kind == kind).count();
        let measured =
            || cases.iter().filter(|case| case.is_measured).map(|case| case.base.clone()).collect();
        Self {
            schema: study.design.schema().to_owned(),
            calibration: calibration(study.design, scores),
            design: design(study),
            failed: is_field.then(|| failed(cases)),
            key_sha256: key_sha256.to_owned(),
            measured_bases: is_field.then(measured),
            measures: scores.measures.clone(),
            name: study.name.clone(),
            not_observable: is_field.then(|| not_observable(cases)),
            partial: None,
            question: study.question.clone(),
            refused: refused(study.design, cases),
            rigs: kinds.map(|kind| (study.design.name(kind).to_owned(), count(kind))).collect(),
            seed: study.seed,
            strata: is_field.then(|| scores.strata.clone()),
            study: study.design.study().to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            tables: tables.map(|(name, table)| ((*name).to_owned(), table.clone())).collect(),
        }
    }

    /// The text of the file. Keys stand in the order of the alphabet.
    pub(crate) fn text(&self) -> String {
        stamped(&self.schema, &serde_json::to_value(self).expect("numbers and strings are JSON"))
    }
}

/// Diagnoses that were refused.
pub(crate) fn failed(cases: &[Case]) -> usize {
    cases.iter().flat_map(|case| &case.answers).filter(|answer| answer.reply.status == "failed").count()
}

/// Faults that are too small to be asked for.
pub(crate) fn not_observable(cases: &[Case]) -> usize {
    cases.iter().filter(|case| case.fault.as_ref().is_some_and(|fault| !fault.is_observable())).count()
}

fn refused(design: Design, cases: &[Case]) -> Vec<Refused> {
    let refused = |case: &Case| match design {
        Design::Laboratory => (case.reply().status == "failed").then_some(Refused::Rig(case.id)),
        Design::Field => case.refused.clone().map(|why| Refused::Reported { id: case.id, why }),
    };
    cases.iter().filter_map(refused).collect()
}

fn calibration(design: Design, scores: &Scores) -> Value {
    let claims = &scores.claims;
    match design {
        Design::Laboratory => {
            json!({ "bins": claims.bins, "ece": claims.error, "top_ece": scores.top_error })
        }
        Design::Field => json!(claims),
    }
}

fn design(study: &Study) -> Value {
    match study.design {
        Design::Laboratory => json!({
            "systems": study.systems, "sizes": study.sizes, "seeds": study.seeds, "none": study.none,
            "outside": study.outside, "pairs": study.pairs, "slice": study.slice,
        }),
        Design::Field => json!({
            "effects": study.effects, "sizes": study.sizes, "seeds": study.seeds, "made": study.made, "none": study.none,
            "resampled": study.resampled, "outside": study.outside, "slice": study.slice,
        }),
    }
}
